// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nadir {

/// Pixels or lidar points that did not reach the map, by the first reason that held.
struct DroppedPoints {
  std::int64_t no_disparity = 0;  ///< stereo: no match; lidar: not finite, or no range
  std::int64_t range = 0;         ///< nearer or farther than the limits
  std::int64_t height = 0;        ///< outside the height gate about the sensor
  std::int64_t outside = 0;       ///< outside the grid
  std::int64_t texture = 0;       ///< stereo: the image is too plain there for a match
  std::int64_t sparse = 0;        ///< too few in a cell that nothing is known of yet
  std::int64_t gate = 0;          ///< in cells whose height contradicts the map

  std::int64_t total() const {
    return no_disparity + range + height + outside + texture + sparse + gate;
  }
};

enum class MappingStatus {
  kOk,
  kNoGround,  ///< no row of the image looks below the horizon
  kNoPoints,  ///< every point was dropped; `dropped` says why
};
std::string to_string(MappingStatus status);

/// Wall-clock milliseconds of the stages of one frame.
struct StageTimes {
  double rectify = 0.0;    ///< undistortion, scaling, grey
  double depth = 0.0;      ///< disparity
  double points = 0.0;     ///< pixels or ranges to points, gates
  double aggregate = 0.0;  ///< points to one measurement per cell
  double fuse = 0.0;       ///< grid move, height and colour update
  double clean = 0.0;      ///< seen-through test
  double colour = 0.0;     ///< inverse colouring

  double total() const { return rectify + depth + points + aggregate + fuse + clean + colour; }
};

/// What became of one frame.
struct FrameStatistics {
  MappingStatus status = MappingStatus::kOk;  ///< anything else: the map is unchanged
  std::int64_t points_in = 0;                 ///< pixels below the horizon, or lidar points
  DroppedPoints dropped;
  int cells_new = 0;
  int cells_updated = 0;
  int cells_rejected = 0;    ///< contradicted the map: kept as its second hypothesis
  int cells_replaced = 0;    ///< the second hypothesis won
  int cells_cleared = 0;     ///< seen through
  bool map_dropped = false;  ///< the pose jumped: the map starts anew with this frame
  /// |measured - mapped height| over the cells seen before; NaN where there are none. Poses that do
  /// not fit the images raise them.
  double innovation_median_m = 0.0;
  double innovation_p90_m = 0.0;
  double exposure_gain = 1.0;  ///< by which the frame's colours were multiplied
  StageTimes ms;
  std::vector<std::string> warnings;  ///< one sentence each
};

}  // namespace nadir
