// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/report/canvas.hpp"

namespace nadir::report {

/// Which place of a raster a sheet shows: at (u, v), continuous sheet pixels from the upper left
/// corner, lies the raster's continuous pixel (a[0] u + a[1] v + a[2], a[3] u + a[4] v + a[5]).
using PixelTransform = std::array<double, 6>;

/// A stretch of ground, resampled to the sheet's pixels.
struct Imagery {
  Raster<std::uint8_t> colour;   ///< RGB
  Raster<std::uint8_t> opacity;  ///< 0 where nothing was seen; soft at edges
};

/// Resamples a map: averages where it shrinks, interpolates where it grows; masked pixels never
/// bleed into the others.
Imagery resample(const Orthomosaic& map, const PixelTransform& map_from_sheet, int width,
                 int height);

/// Makes the image grey, and brightens it by `lift` 0 .. 1 towards white.
void make_grey(Imagery& imagery, double lift);

/// Fills a box with the neutral hatching that stands for "no data".
void draw_hatching(Canvas& canvas, const Box& box);

}  // namespace nadir::report
