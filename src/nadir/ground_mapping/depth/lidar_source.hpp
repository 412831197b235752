// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/ground_mapping/depth/depth_source.hpp"
#include "nadir/ground_mapping/options.hpp"

namespace nadir::ground {

/// The points of a lidar sweep, each brought to the pose that the robot had when it was measured,
/// coloured by the camera that sees it sharpest and unhidden.
class LidarSource {
 public:
  using SensorFrame = LidarFrame;

  /// Throws Error (input) for a rig whose poses are not finite or whose cameras cannot be.
  LidarSource(const LidarRig& rig, const GroundMappingOptions& options);

  Measurement measure(const LidarFrame& frame, const OdomPose3& odom_from_robot,
                      const RobotMotion& motion, FrameStatistics& statistics);
  std::optional<Sighting> sighting(const LidarFrame& frame) const;
  double min_range_m() const { return options_.lidar_min_range_m; }
  double max_range_m() const { return options_.lidar_max_range_m; }
  static int min_points() { return 1; }

 private:
  void to_points(const LidarFrame& frame, const OdomPose3& odom_from_robot,
                 const RobotMotion& motion, Measurement& measurement,
                 FrameStatistics& statistics) const;
  void colour(Measurement& measurement) const;

  LidarRig rig_;
  GroundMappingOptions options_;
};
static_assert(DepthSource<LidarSource>);

}  // namespace nadir::ground
