// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "nadir/report/canvas.hpp"

namespace nadir::report {

/// The values that a colour map stands for.
struct ColourScale {
  double low = 0.0;
  double high = 1.0;
  std::string name;
};

/// A horizontal colour bar with ticks and its name below, or a vertical one, with the name above,
/// where `box` is taller than wide.
void draw_colour_bar(Canvas& canvas, const Box& box, ColourMap map, const ColourScale& scale);

}  // namespace nadir::report
