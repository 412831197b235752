// SPDX-License-Identifier: Apache-2.0
#include "cli/exit_code.hpp"

#include <fmt/format.h>

namespace nadir::cli {

std::string exit_codes_in_words() {
  constexpr std::size_t kWidth = 92;
  std::string text = "Exit codes:";
  std::size_t column = text.size();
  for (std::size_t i = 0; i < kExitCodes.size(); ++i) {
    const bool last = i + 1 == kExitCodes.size();
    const std::string item = fmt::format("{} {}{}", static_cast<int>(kExitCodes[i].code),
                                         kExitCodes[i].name, last ? "." : ",");
    const bool fits = column + 1 + item.size() <= kWidth;
    text += fits ? " " : "\n";
    column = (fits ? column + 1 : 0) + item.size();
    text += item;
  }
  return text + "\n";
}

std::string exit_codes_in_markdown() {
  std::string text = "| code | name | meaning |\n|---|---|---|\n";
  for (const ExitCodeMeaning& row : kExitCodes) {
    text += fmt::format("| {} | {} | {} |\n", static_cast<int>(row.code), row.name, row.meaning);
  }
  return text;
}

}  // namespace nadir::cli
