// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/frames.hpp"
#include "nadir/core/geo_reference.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/stamp.hpp"

namespace nadir {

/// A view from straight above: grey (1 channel) or RGB (3 channels) with the mask of what was
/// really seen. An invalid pixel is marked in the mask and nowhere else: its colour means nothing.
struct Orthomosaic {
  Raster<std::uint8_t> image;  ///< 1 or 3 channels
  Raster<std::uint8_t> valid;  ///< same size, 1 channel; 0 = hole, anything else = seen
  GeoReference geo;

  int width() const { return image.width(); }
  int height() const { return image.height(); }
};

/// One observation of the ground robot: what it saw around itself, and how it says it moved.
struct Frame {
  Stamp stamp;
  /// The local orthomosaic. Its geo-reference places the pixels in the robot frame: x forward is
  /// to the right, y left is up, and (0, 0) is the robot.
  Orthomosaic local;
  /// The odometry at this instant, where there is any.
  std::optional<OdomPose2> odom_from_robot = std::nullopt;
  /// Heights of the same place in the same frame, above the robot's ground, where known.
  std::optional<ElevationMap> elevation = std::nullopt;
};

}  // namespace nadir
