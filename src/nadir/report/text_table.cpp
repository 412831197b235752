// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace nadir {

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    std::string line = "  ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                     : fmt::format("  {:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

std::string fixed(double value, int places) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, places) : "-";
}

std::string percent(double share) { return fixed(100.0 * share, 1) + " %"; }

}  // namespace nadir
