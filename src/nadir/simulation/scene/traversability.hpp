// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Where a robot may drive, in cells of the plane, and paths through it.
class TraversabilityGrid {
 public:
  static constexpr double kClearance = 1.5;     ///< that a path keeps, metres
  static constexpr double kCornerRadius = 2.5;  ///< for the corners of path(), metres

  /// Cell (column, row) covers low + (column .. column + 1, row .. row + 1) cell_m and is free
  /// where the raster is not 0; row 0 is SOUTH. What lies beyond is not free.
  TraversabilityGrid(const Raster<std::uint8_t>& free, Eigen::Vector2d low, double cell_m);

  /// Distance from the middle of this place's cell to that of the nearest which is not free,
  /// metres: 0 in such a one.
  double clearance(const Eigen::Vector2d& point) const;
  /// Corners of a long path over the largest part that keeps the clearance: from the costliest
  /// place to reach to the one that is costliest from there. It prefers the middle of what is free.
  /// Rounded by kCornerRadius or less, it stays on free cells. Empty where no such path is longer
  /// than 20 m.
  std::vector<Eigen::Vector2d> path() const;

 private:
  Eigen::Vector2d low_;
  double cell_m_;
  cv::Mat1f clearance_;  ///< in cells
};

}  // namespace nadir::simulation
