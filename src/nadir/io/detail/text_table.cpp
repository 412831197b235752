// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/text_table.hpp"

#include <algorithm>
#include <sstream>

#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

std::string trimmed(const std::string& text) {
  constexpr const char* kBlanks = " \t\r\"";
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string> split(const std::string& line) {
  char separator = ',';
  for (const char candidate : {';', '\t'}) {
    if (line.find(candidate) != std::string::npos) separator = candidate;
  }
  std::vector<std::string> fields;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    const std::size_t end = std::min(line.find(separator, begin), line.size());
    fields.push_back(trimmed(line.substr(begin, end - begin)));
    begin = end + 1;
  }
  return fields;
}

}  // namespace

std::vector<TextRow> read_text_table(const std::filesystem::path& path) {
  std::string text = read_file(path);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // byte order mark
  std::vector<TextRow> rows;
  std::istringstream lines(text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    TextRow row{file_and_line(path, number), trimmed(line), {}, split(line)};
    if (row.text.empty() || (row.text.starts_with('#') && !rows.empty())) continue;
    std::istringstream words(row.text);
    for (std::string word; words >> word;) row.words.push_back(word);
    if (row.words.empty()) continue;  // of form feeds alone
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace nadir
