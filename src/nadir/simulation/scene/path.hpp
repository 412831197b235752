// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

namespace nadir::simulation {

/// A place as seen from a path: metres along it, and metres to the left of it.
struct PathPoint {
  double along = 0.0;
  double across = std::numeric_limits<double>::infinity();
};

/// A place on a path with its direction, radians counter-clockwise from east.
struct PathPose {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  double yaw = 0.0;
};

/// A planar curve of straight lines and tangent circular arcs, as roads are laid out: continuous in
/// direction, with exact coordinates along and across it.
class Path {
 public:
  Path() = default;
  /// The polyline through `corners`, each inner corner rounded by an arc of the next of `radii_m`
  /// (the last one for all that follow), or less where its sides are too short. An endless path
  /// goes on straight beyond its ends.
  Path(std::span<const Eigen::Vector2d> corners, std::span<const double> radii_m,
       bool endless = true);

  double length() const { return length_; }
  /// Beyond either end the direction is kept.
  PathPose at(double along) const;
  Eigen::Vector2d place(PathPoint point) const;
  /// The nearest place of the path.
  PathPoint locate(const Eigen::Vector2d& point) const;

 private:
  struct Piece {
    double start = 0.0;
    double length = 0.0;
    Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< where it begins
    double yaw = 0.0;
    Eigen::Vector2d direction = Eigen::Vector2d::UnitX();
    double bend = 0.0;  ///< 1 / radius, positive to the left; 0 = straight
    Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  };
  void add(double length, double bend);
  static PathPoint locate_on(const Piece& piece, const Eigen::Vector2d& point, double low,
                             double high);

  static double least_distance(const Piece& piece, const Eigen::Vector2d& point);

  std::vector<Piece> pieces_;
  double length_ = 0.0;
  bool endless_ = true;
};

}  // namespace nadir::simulation
