// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// The grey value that a hole has where holes take part (`whole_square`): white, on both sides.
inline constexpr float kHoleGrey = 255.0F;

/// What the options make of the pixels of both maps.
struct PixelRole {
  bool weighted = false;        ///< the score weighs pixels by equation [4]
  bool weighted_norms = false;  ///< in its means and norms too (zwncc), and so in what is compared
  bool whole_square = false;    ///< holes take part, as white pixels (ssd, sad, wncc_paper)
  PaperWeight weight = PaperWeight::kNormalised;
};
PixelRole pixel_role(const MatchingOptions& options);

/// The weight of equation [4] over a template of `width` x `height` pixels at a continuous pixel
/// coordinate. Normalised: 2 - |ds| |dt| with ds, dt in half sides: 2 in the centre, 1 in the
/// corners. Literal: |2 - |M/2 - s| |N/2 - t|| in pixels, which grows outwards.
double pixel_weight(PaperWeight kind, PixelCoordinate at, int width, int height);

/// A template turned by a heading and resampled on the map's pixel grid, for a robot that stands
/// on the centre of a pixel. All rasters have one size; pixels that take no part are 0 in `mask`.
struct RotatedTemplate {
  int left = 0;             ///< column of its first pixel relative to the robot's pixel
  int top = 0;              ///< row likewise
  Raster<float> value;      ///< grey, bilinear over the seen pixels
  Raster<float> mask;       ///< 1 = takes part
  Raster<float> weight;     ///< mask, times the weight of the score where it has one
  Raster<float> seen;       ///< as `weight` (1 where unweighted), but 0 on holes: what is compared
  double total_seen = 0.0;  ///< sum of `seen`
};
RotatedTemplate rotate_template(const ChannelImage& local, double yaw_rad, double map_resolution,
                                const PixelRole& role);
/// The same for many headings, in parallel.
std::vector<RotatedTemplate> rotate_templates(const ChannelImage& local,
                                              std::span<const double> yaws_rad,
                                              double map_resolution, const PixelRole& role);

}  // namespace nadir
