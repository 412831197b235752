// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "nadir/report/map_figure.hpp"

namespace nadir::report {

inline constexpr double kPatchSide = 400.0;  ///< pixels

/// Where everything of a heat map figure lies.
struct HeatMapLayout {
  int width = 0;
  int height = 0;
  MapView view;
  Box bar;
  std::array<Box, 3> patches;  ///< local map, map, both
  Box legend;  ///< entries stand in a row where it has a height, else one above the other
  Box furniture;
};

/// A wide region has its patches below the map, any other beside it.
HeatMapLayout lay_out_heat_map(const Region& region);

}  // namespace nadir::report
