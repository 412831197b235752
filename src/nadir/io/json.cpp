// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/json.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

constexpr const char* kBytesSuffix = "_hex";

/// Bytes of the UTF-8 character that the text begins with; 0 where it begins with none.
std::size_t character_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[i]); };
  const std::uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xc0) != 0x80) return 0;
  }
  // Neither longer than needed, nor half of a UTF-16 pair, nor beyond U+10FFFF.
  if (first == 0xe0 && byte(1) < 0xa0) return 0;
  if (first == 0xed && byte(1) > 0x9f) return 0;
  if (first == 0xf0 && byte(1) < 0x90) return 0;
  if (first == 0xf4 && byte(1) > 0x8f) return 0;
  return length;
}

std::string hexadecimal(std::string_view bytes) {
  std::string digits;
  for (const char byte : bytes) digits += fmt::format("{:02x}", static_cast<std::uint8_t>(byte));
  return digits;
}

std::string bytes_of(const std::string& digits, const std::string& key) {
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    const char* begin = digits.data() + i;
    std::uint8_t byte = 0;
    const auto [end, error] = std::from_chars(begin, begin + 2, byte, 16);
    if (digits.size() % 2 != 0 || error != std::errc{} || end != begin + 2) {
      throw Error(ErrorKind::kInput, "'" + digits + "' is not hexadecimal", key);
    }
    bytes += static_cast<char>(byte);
  }
  return bytes;
}

}  // namespace

std::string json_text(const Json& document, int indent) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = character_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

void set_name(Json& object, const std::string& key, std::string_view name) {
  object[key] = name;
  if (!is_utf8(name)) object[key + kBytesSuffix] = hexadecimal(name);
}

std::string name_at(const Json& object, const std::string& key) {
  const auto bytes = object.find(key + kBytesSuffix);
  if (bytes != object.end()) return bytes_of(bytes->get<std::string>(), key + kBytesSuffix);
  return object.at(key).get<std::string>();
}

}  // namespace nadir
