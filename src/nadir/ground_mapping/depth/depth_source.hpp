// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <concepts>
#include <optional>

#include "nadir/ground_mapping/depth/points.hpp"
#include "nadir/ground_mapping/depth/sighting.hpp"

namespace nadir::ground {

/// A depth sensor: turns one of its frames into points with their variances and colours. It counts
/// what it drops and writes its times into the statistics, and keeps no map.
template <class Source>
concept DepthSource = requires(Source& source, const Source& constant,
                               const typename Source::SensorFrame& frame, const OdomPose3& pose,
                               const RobotMotion& motion, FrameStatistics& statistics) {
  { source.measure(frame, pose, motion, statistics) } -> std::same_as<Measurement>;
  /// The frame that was measured last, for the check of the poses; nothing where the frame has no
  /// image with depths.
  { constant.sighting(frame) } -> std::same_as<std::optional<Sighting>>;
  { constant.min_range_m() } -> std::same_as<double>;
  { constant.max_range_m() } -> std::same_as<double>;
  /// Points of one frame that begin a cell.
  { constant.min_points() } -> std::same_as<int>;
};

}  // namespace nadir::ground
