// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace nadir {

/// Rows of cells in aligned columns: the first to the left, the others to the right. The first row
/// is the head.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// A number for reading, with `places` decimals.
std::string fixed(double value, int places);

/// A share for reading, with one decimal.
std::string percent(double share);

}  // namespace nadir
