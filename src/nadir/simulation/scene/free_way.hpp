// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Cells of the plane that a robot may drive over. Cell (column, row) covers low + (column ..
/// column + 1, row .. row + 1) cell_m; row 0 is SOUTH. What lies beyond is not free.
struct FreeGround {
  Raster<std::uint8_t> free;  ///< 255 = free
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  double cell_m = 0.5;

  Eigen::Vector2d middle(int column, int row) const {
    return low + cell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
  }
  bool at(const Eigen::Vector2d& point) const;
};

inline constexpr double kFreeWayRadius = 2.5;  ///< of its corners, metres

/// The corners of a long way over the largest free part: between the two places of it that lie
/// farthest apart by the way that keeps to the middle. It stays 1.5 m clear of what is not free,
/// and of that 0.4 m remain where its corners are rounded by kFreeWayRadius or less. Empty where no
/// part is that wide.
std::vector<Eigen::Vector2d> free_way(const FreeGround& ground);

}  // namespace nadir::simulation
