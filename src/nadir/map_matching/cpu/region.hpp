// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "nadir/core/raster.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::cpu {

/// Where the part of the map lies that a set of templates can touch while the robot stands in a
/// window.
struct RegionPlace {
  /// The region's first pixel relative to the window's.
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  /// Smallest period at which a cyclic correlation of the region with any of the templates equals
  /// the linear one over the window.
  int period_width = 0;
  int period_height = 0;
};

struct Region {
  RegionPlace place;
  Raster<float> value;       ///< grey; a hole is 0, or white where holes take part
  Raster<float> takes_part;  ///< 1 where the pixel takes part in sums
  Raster<float> valid;       ///< 1 where the map was really seen
};

/// How far a region reaches beyond the map: not at all, where holes take no part and zeros serve;
/// or as far as the templates do.
enum class RegionExtent { kWithinMap, kWhole };

RegionPlace place_region(const ChannelImage& map, std::span<const RotatedTemplate> templates,
                         const PixelWindow& window, RegionExtent extent);

/// The map's pixels there.
Region cut_region(const ChannelImage& map, const RegionPlace& place, const PixelWindow& window,
                  bool whole_square);

/// Outer bounds of the templates relative to the robot's pixel; right and bottom are one beyond.
struct TemplateBounds {
  int left = 0, top = 0, right = 0, bottom = 0;
};
TemplateBounds bounds_of(std::span<const RotatedTemplate> templates);

/// Mean grey of the pixels that take part.
double mean_grey(const Raster<float>& value, const Raster<float>& mask);

/// a * b, pixel by pixel.
Raster<float> times(const Raster<float>& a, const Raster<float>& b);

/// mask * (value - shift) / 64.
Raster<float> shifted(const Raster<float>& value, const Raster<float>& mask, double shift);

}  // namespace nadir::cpu
