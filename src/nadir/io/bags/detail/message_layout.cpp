// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/bags/detail/message_layout.hpp"

#include <cstdint>
#include <cstring>
#include <optional>

namespace nadir::ros1 {
namespace {

/// One reading of a message along its layout.
class LayoutWalk {
 public:
  explicit LayoutWalk(std::string_view bytes) : bytes_(bytes) {}

  bool take(std::string_view layout) {
    while (!layout.empty()) {
      if (layout.front() == '(') {
        const std::size_t close = layout.find(')');
        if (!take_list_of(layout.substr(1, close - 1))) return false;
        layout.remove_prefix(close + 1);
      } else if (layout.front() == 'v') {
        const auto count = number();
        if (!count || !skip(std::uint64_t{*count} * size_of(layout[1]))) return false;
        layout.remove_prefix(2);
      } else {
        if (!skip(size_of(layout.front()))) return false;
        layout.remove_prefix(1);
      }
    }
    return true;
  }

 private:
  static std::uint64_t size_of(char digit) { return static_cast<std::uint64_t>(digit - '0'); }

  bool skip(std::uint64_t size) {
    if (size > bytes_.size()) return false;
    bytes_.remove_prefix(static_cast<std::size_t>(size));
    return true;
  }

  std::optional<std::uint32_t> number() {
    std::uint32_t value = 0;
    if (bytes_.size() < sizeof(value)) return std::nullopt;
    std::memcpy(&value, bytes_.data(), sizeof(value));
    bytes_.remove_prefix(sizeof(value));
    return value;
  }

  bool take_list_of(std::string_view layout) {
    const auto count = number();
    if (!count) return false;
    for (std::uint32_t i = 0; i < *count; ++i) {
      if (!take(layout)) return false;
    }
    return true;
  }

  std::string_view bytes_;
};

}  // namespace

bool has_layout(std::string_view bytes, std::string_view layout) {
  return LayoutWalk(bytes).take(layout);
}

}  // namespace nadir::ros1
