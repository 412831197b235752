// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/file_names.hpp"

#include <cstdint>

namespace nadir {

std::string short_name(const std::filesystem::path& name, std::size_t longest) {
  std::string text = name.string();
  if (text.size() <= longest) return text;
  std::size_t end = longest;
  const auto continues = [&](std::size_t i) {
    return (static_cast<std::uint8_t>(text[i]) & 0xc0) == 0x80;
  };
  // A character has three such bytes at most; where there are more, the name is not UTF-8.
  for (int i = 0; i < 3 && continues(end); ++i) --end;
  text.resize(continues(end) ? longest : end);
  return text;
}

}  // namespace nadir
