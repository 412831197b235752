// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/height_channel.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/core/error.hpp"
#include "nadir/map_matching/ground_level.hpp"
#include "nadir/map_matching/resample.hpp"

namespace nadir {
namespace {

/// Grey value of the ground, and how far a thing can rise above it.
constexpr double kGroundGrey = 128.0;
constexpr double kGreyRange = 127.0;

/// The lowest known height is subtracted first: what is left is small and exact in float.
GreyImage known_heights(const ElevationMap& heights) {
  const Raster<float>& height = heights.height_m;
  GreyImage known{Raster<float>(height.width(), height.height()),
                  Raster<std::uint8_t>(height.width(), height.height()), heights.geo};
  float lowest = std::numeric_limits<float>::infinity();
  for (const float value : height.values()) {
    if (std::isfinite(value)) lowest = std::min(lowest, value);
  }
  for (std::size_t i = 0; i < height.values().size(); ++i) {
    if (!std::isfinite(height.values()[i])) continue;
    known.value.values()[i] = height.values()[i] - lowest;
    known.valid.values()[i] = 1;
  }
  return known;
}

/// Linear near the ground, where a kerb is to be seen, and ever flatter above: a wall is not more
/// alike for being higher.
std::uint8_t grey_of(double above_ground_m, double scale_m) {
  const double compressed = above_ground_m / (std::abs(above_ground_m) + scale_m);
  return static_cast<std::uint8_t>(std::lround(kGroundGrey + kGreyRange * compressed));
}

}  // namespace

ChannelImage make_height_channel(const ElevationMap& heights, const MatchingOptions& options,
                                 const std::string& what) {
  if (heights.height_m.empty()) throw Error(ErrorKind::kInput, what + " has no pixels");
  if (!(heights.geo.resolution > 0.0) || !std::isfinite(heights.geo.resolution)) {
    throw Error(ErrorKind::kInput, what + " has no positive resolution");
  }
  GreyImage known = resample(known_heights(heights), options.resolution_m);
  const Raster<float> ground = ground_level(known, options.height_sigma_m / options.resolution_m);
  ChannelImage channel{Raster<std::uint8_t>(known.value.width(), known.value.height()),
                       std::move(known.valid), known.geo};
  for (std::size_t i = 0; i < channel.value.values().size(); ++i) {
    if (channel.valid.values()[i] == 0) continue;
    const auto rise = static_cast<double>(known.value.values()[i] - ground.values()[i]);
    if (rise > options.height_ceiling_m) {
      channel.valid.values()[i] = 0;
    } else {
      channel.value.values()[i] = grey_of(rise, options.height_scale_m);
    }
  }
  return channel;
}

}  // namespace nadir
