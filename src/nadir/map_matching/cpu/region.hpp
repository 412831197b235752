// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "nadir/core/raster.hpp"
#include "nadir/map_matching/cpu/fft.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::cpu {

/// The part of the map that a set of templates can touch while the robot stands in a window, cut
/// out and padded with holes beyond the map's edge.
struct Region {
  /// Outer bounds of the templates relative to the robot's pixel.
  int template_left = 0;
  int template_top = 0;
  Raster<float> value;       ///< grey; a hole is 0, or white where holes take part
  Raster<float> takes_part;  ///< 1 where the pixel takes part in sums
  Raster<float> valid;       ///< 1 where the map was really seen
};

Region cut_region(const ChannelImage& map, std::span<const RotatedTemplate> templates,
                  const PixelWindow& window, bool whole_square);

/// Mean grey of the pixels that take part.
double mean_grey(const Raster<float>& value, const Raster<float>& mask);

/// a * b, pixel by pixel.
Raster<float> times(const Raster<float>& a, const Raster<float>& b);

/// mask * (value - shift) / 64.
Raster<float> shifted(const Raster<float>& value, const Raster<float>& mask, double shift);

}  // namespace nadir::cpu
