// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "nadir/report/figures.hpp"

namespace nadir {

/// Charts as SVG: sharp at any size, and light or dark as the reader's system is. Each is a whole
/// document that may also stand inside an HTML page. The same input gives the same bytes.

/// Stacked panels that share their x axis, as draw_panels() draws them.
std::string svg_panels(const std::vector<Panel>& panels, const std::string& x_label,
                       const std::string& title);

/// A row of a chart of rows: values that are not finite or negative are left out.
struct Sample {
  std::string name;
  std::vector<double> values;
};

/// A row for each sample, from zero: a box from the lower to the upper quartile, a line at the
/// median, whiskers at 5 and 95 %, a dot at the largest; the median as a number. A sample of one
/// value is a bar.
std::string svg_rows(const std::vector<Sample>& samples, const std::string& x_label,
                     const std::string& title);

}  // namespace nadir
