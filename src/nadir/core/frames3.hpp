// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>

#include "nadir/core/frames.hpp"

namespace nadir {

namespace frames {
struct Camera {};       ///< x right, y down, z forward; of a photo, or the left of a stereo pair
struct RightCamera {};  ///< the right camera of a stereo pair, same axes
struct Lidar {};        ///< x forward, y left, z up
}  // namespace frames

/// A point of space, metres, in the named frame; Map, Odom and Robot have z up.
template <class Frame>
struct Point3 {
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;

  Eigen::Vector3d vector() const { return {x, y, z}; }
  static Point3 from(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
};

/// A rigid motion of space that takes coordinates in `From` to coordinates in `To`; equally, the
/// pose of `From` in `To`. The spatial sister of Transform2, with the same naming:
/// `odom_from_camera = odom_from_robot * robot_from_camera`.
template <class To, class From>
struct Transform3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< of unit length
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         ///< metres

  Point3<To> operator*(const Point3<From>& point) const {
    return Point3<To>::from(rotation * point.vector() + translation);
  }

  template <class Other>
  Transform3<To, Other> operator*(const Transform3<From, Other>& other) const {
    return {(rotation * other.rotation).normalized(), rotation * other.translation + translation};
  }

  Transform3<From, To> inverse() const {
    const Eigen::Quaterniond back = rotation.conjugate();
    return {back, -(back * translation)};
  }

  bool is_finite() const { return rotation.coeffs().allFinite() && translation.allFinite(); }
};

/// The heading of a pose: the direction of its x axis in the plane, radians counter-clockwise from
/// the x axis of `To`. Undefined (0) where that axis is vertical.
template <class To, class From>
double yaw_of(const Transform3<To, From>& pose) {
  const Eigen::Vector3d forward = pose.rotation * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

/// The pose seen from above: x, y and heading.
template <class To, class From>
Transform2<To, From> planar(const Transform3<To, From>& pose) {
  return {pose.translation.x(), pose.translation.y(), wrap_angle(yaw_of(pose))};
}

/// A planar pose in space, level, at the height `z`.
template <class To, class From>
Transform3<To, From> spatial(const Transform2<To, From>& pose, double z = 0.0) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(pose.yaw, Eigen::Vector3d::UnitZ())),
          {pose.x, pose.y, z}};
}

/// The camera's axes in a robot that carries it level and looking forward (x right, y down, z
/// forward against x forward, y left, z up): the rotation of robot_from_camera.
inline Eigen::Quaterniond forward_camera_rotation() {
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(axes);
}

}  // namespace nadir
