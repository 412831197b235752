// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/shell.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include "nadir/io/json.hpp"

namespace nadir {
namespace {

constexpr std::string_view kSafe =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./,:=+@%";

bool is_control(char byte) {
  constexpr std::uint8_t kDelete = 0x7f;
  return static_cast<std::uint8_t>(byte) < ' ' || static_cast<std::uint8_t>(byte) == kDelete;
}

/// $'...': what is not plain text becomes its three octal digits.
std::string in_codes(const std::string& word) {
  const bool readable = is_utf8(word);
  std::string text = "$'";
  for (const char byte : word) {
    const auto code = static_cast<std::uint8_t>(byte);
    const bool plain = !is_control(byte) && (readable || code < 0x80) && byte != '\'';
    text += plain && byte != '\\' ? std::string(1, byte) : fmt::format("\\{:03o}", code);
  }
  return text + "'";
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  // zsh takes a word that begins with = for the path of a program.
  const bool safe =
      !word.empty() && word.front() != '=' && word.find_first_not_of(kSafe) == std::string::npos;
  if (safe) return word;
  if (!is_utf8(word) || std::ranges::any_of(word, is_control)) return in_codes(word);
  std::string text = "'";
  for (const char byte : word) text += byte == '\'' ? std::string("'\\''") : std::string(1, byte);
  return text + "'";
}

std::string shell_quoted_path(const std::filesystem::path& path) {
  const std::string text = path.string();
  return shell_quoted(text.starts_with('-') ? "./" + text : text);
}

std::string shell_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_quoted(word);
  return line;
}

}  // namespace nadir
