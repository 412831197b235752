// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/camera.hpp"
#include "nadir/core/frames3.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/stamp.hpp"

namespace nadir {

/// The pose of the robot in its odometry frame, in space (z up).
using OdomPose3 = Transform3<frames::Odom, frames::Robot>;

/// A pose of the robot at an instant.
struct StampedOdomPose3 {
  Stamp stamp;
  OdomPose3 odom_from_robot;
};

/// Two cameras fixed to each other and to the robot.
struct StereoRig {
  CameraModel left;
  CameraModel right;
  Transform3<frames::RightCamera, frames::Camera> right_from_left;
  Transform3<frames::Robot, frames::Camera> robot_from_left;
  /// The images are rectified: no distortion, equal intrinsics, rows aligned; then right_from_left
  /// is a shift by (-baseline, 0, 0).
  bool rectified = false;

  double baseline_m() const { return right_from_left.translation.norm(); }
};

/// What a stereo camera saw at one instant.
struct StereoFrame {
  Stamp stamp;
  Raster<std::uint8_t> left;   ///< grey (1 channel) or RGB (3)
  Raster<std::uint8_t> right;  ///< same size and channels
};

struct LidarPoint {
  float x = 0.0F;  ///< metres, lidar frame
  float y = 0.0F;
  float z = 0.0F;
  float intensity = 0.0F;
  /// Time since the stamp of the scan, seconds; 0 where the sensor does not say.
  float time_offset_s = 0.0F;
};

/// A camera that colours the points of a lidar.
struct MountedCamera {
  CameraModel model;
  Transform3<frames::Robot, frames::Camera> robot_from_camera;
};

/// A lidar and the cameras that colour it, fixed to the robot.
struct LidarRig {
  Transform3<frames::Robot, frames::Lidar> robot_from_lidar;
  std::vector<MountedCamera> cameras;
};

/// One sweep of a lidar with the images taken at its instant.
struct LidarFrame {
  Stamp stamp;
  std::vector<LidarPoint> points;
  std::vector<Raster<std::uint8_t>> images;  ///< one a camera of the rig, grey or RGB; may be empty
};

}  // namespace nadir
