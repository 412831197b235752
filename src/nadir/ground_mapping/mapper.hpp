// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/local_map.hpp"
#include "nadir/ground_mapping/options.hpp"
#include "nadir/ground_mapping/pose_fit.hpp"
#include "nadir/ground_mapping/statistics.hpp"

namespace nadir {

/// The ground robot's view from above: frames and poses in, local orthomosaics out. A rolling grid
/// in the odometry frame holds a height and a colour per cell. The result does not depend on the
/// number of threads or on the order of the points.
///
/// @code
/// GroundMapper mapper(rig, GroundMappingOptions{});
/// for (const auto& [frame, odom_from_robot] : drive) mapper.integrate(frame, odom_from_robot);
/// const LocalMap local = mapper.render(RenderOptions{});
/// @endcode
class GroundMapper {
 public:
  /// Throws Error (input) for a rig that cannot be: no focal length, no baseline, image sizes that
  /// differ; Error (usage) for options that contradict each other or the rig.
  GroundMapper(const StereoRig& rig, const GroundMappingOptions& options);
  GroundMapper(const LidarRig& rig, const GroundMappingOptions& options);
  ~GroundMapper();
  GroundMapper(GroundMapper&&) noexcept;
  GroundMapper& operator=(GroundMapper&&) noexcept;
  GroundMapper(const GroundMapper&) = delete;
  GroundMapper& operator=(const GroundMapper&) = delete;

  /// Takes one frame; frames come in the order of their stamps. A frame without a usable point is
  /// skipped and leaves the map as it is: see the status.
  /// Throws Error (input) for a non-finite pose, a stamp that does not increase, an image of
  /// another size than the rig's, left and right swapped (first frame), depth in millimetres, or
  /// poses that plainly do not fit the images (PoseFit, is_gross); Error (usage) for a frame of the
  /// other sensor.
  FrameStatistics integrate(const StereoFrame& frame, const OdomPose3& odom_from_robot);
  FrameStatistics integrate(const LidarFrame& frame, const OdomPose3& odom_from_robot);

  /// How the poses of the frames so far fit their images; empty without options.check_poses. What
  /// to make of it is the caller's: pose_misfit, is_gross.
  PoseFit pose_fit() const;

  /// Throws Error (usage) before the first frame and for a size that the grid cannot hold.
  LocalMap render(const RenderOptions& options) const;

  /// The stereo range limits that the options and the rig come to, metres; of the lidar likewise.
  double min_range_m() const;
  double max_range_m() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace nadir
