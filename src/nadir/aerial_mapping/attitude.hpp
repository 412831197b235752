// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace nadir {

/// Attitude of a camera that hangs from a drone, radians. Yaw: where the upper edge of a photo that
/// looks straight down points to, 0 = east, counter-clockwise. Pitch: of the optical axis, -pi/2 =
/// straight down. Roll: about the optical axis, 0 = level.
struct PhotoAttitude {
  double yaw = 0.0;
  double pitch = -1.57079632679489661923;
  double roll = 0.0;
};

/// The rotation of map_from_camera: columns are the camera's right, down and forward in the map.
inline Eigen::Matrix3d map_from_camera_rotation(const PhotoAttitude& attitude) {
  const double cy = std::cos(attitude.yaw);
  const double sy = std::sin(attitude.yaw);
  const double cp = std::cos(attitude.pitch);
  const double sp = std::sin(attitude.pitch);
  const Eigen::Vector3d forward{cp * cy, cp * sy, sp};
  const Eigen::Vector3d level_right{sy, -cy, 0.0};
  const Eigen::Vector3d level_down = forward.cross(level_right);
  const double cr = std::cos(attitude.roll);
  const double sr = std::sin(attitude.roll);
  Eigen::Matrix3d rotation;
  rotation.col(0) = cr * level_right + sr * level_down;
  rotation.col(1) = cr * level_down - sr * level_right;
  rotation.col(2) = forward;
  return rotation;
}

/// Yaw of a camera's rotation (map_from_camera), as PhotoAttitude counts it: of the image's upward
/// direction where the camera looks down, of the optical axis where it looks ahead.
inline double yaw_of_camera(const Eigen::Matrix3d& map_from_camera) {
  const Eigen::Vector3d right = map_from_camera.col(0);
  return std::atan2(right.x(), -right.y());
}

}  // namespace nadir
