// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "nadir/core/angle.hpp"

namespace nadir {

/// Coordinate frames (REP-103, REP-105). They exist only as type tags: a transform knows at
/// compile time between which two frames it leads.
namespace frames {
struct Map {};    ///< x east, y north, metres: the frame of the global orthomosaic
struct Odom {};   ///< drifting, continuous: the frame of the robot's odometry
struct Robot {};  ///< x forward, y left
}  // namespace frames

/// A point of the plane, metres, in the named frame.
template <class Frame>
struct Point2 {
  double x = 0.0;
  double y = 0.0;
};

/// A rigid motion of the plane that takes coordinates in `From` to coordinates in `To`; equally,
/// the pose of `From` in `To`. Metres and radians, counter-clockwise; yaw is kept in (-pi, pi].
///
/// Name a transform by its frames, so that neighbours cancel by eye and the compiler checks it:
/// `map_from_robot = map_from_odom * odom_from_robot`.
template <class To, class From>
struct Transform2 {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;

  Point2<To> operator*(const Point2<From>& point) const {
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    return {x + c * point.x - s * point.y, y + s * point.x + c * point.y};
  }

  template <class Other>
  Transform2<To, Other> operator*(const Transform2<From, Other>& other) const {
    const Point2<To> origin = *this * Point2<From>{other.x, other.y};
    return {origin.x, origin.y, wrap_angle(yaw + other.yaw)};
  }

  Transform2<From, To> inverse() const {
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    return {-c * x - s * y, s * x - c * y, wrap_angle(-yaw)};
  }

  bool is_finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(yaw); }
};

/// Metres between the positions of two poses.
template <class To, class From>
double distance(const Transform2<To, From>& a, const Transform2<To, From>& b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// The pose of the robot in the map: `map_from_robot`.
using Pose2 = Transform2<frames::Map, frames::Robot>;
/// The pose of the robot in its odometry frame.
using OdomPose2 = Transform2<frames::Odom, frames::Robot>;
/// The robot's motion between two instants: the later robot frame seen from the earlier one.
using Motion2 = Transform2<frames::Robot, frames::Robot>;

/// Covariance of (x, y, yaw): m^2, m rad, rad^2, in the frame that the pose is expressed in.
using PoseCovariance = Eigen::Matrix3d;

}  // namespace nadir
