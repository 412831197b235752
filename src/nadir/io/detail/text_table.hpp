// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace nadir {

/// One line of a list that people write by hand.
struct TextRow {
  std::string where;                ///< file:line
  std::string text;                 ///< without blanks around it
  std::vector<std::string> words;   ///< separated by blanks
  std::vector<std::string> fields;  ///< separated by the first of ; tab , that occurs; may be empty
};

/// The lines of a text file, without empty ones and those that begin with '#' (but for a first
/// line, which may be a header). Throws Error (input) where the file cannot be read.
std::vector<TextRow> read_text_table(const std::filesystem::path& path);

}  // namespace nadir
