// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Heights of the bare ground on a regular grid, bilinear between its nodes: the exact surface that
/// rays meet. Node (column, row) lies at low + (column + 0.5, row + 0.5) spacing; row 0 is SOUTH.
class HeightField {
 public:
  HeightField() = default;
  HeightField(Raster<float> nodes, Eigen::Vector2d low, double spacing);

  const Eigen::Vector2d& low() const { return low_; }
  Eigen::Vector2d high() const;
  double spacing() const { return spacing_; }
  const Raster<float>& nodes() const { return nodes_; }

  /// Beyond its edge the height of the edge.
  double at(double x, double y) const;
  Eigen::Vector3d normal(double x, double y) const;
  /// Largest height within a rectangle of the plane.
  double top(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const;
  /// First t in [from, to] at which origin + t direction is at or below the surface; NaN = none.
  double meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from,
              double to) const;

 private:
  struct Block {
    float top = 0.0F;
    float slope = 0.0F;  ///< no steeper anywhere in the block
  };
  double refine(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double above,
                double below) const;

  Raster<float> nodes_;
  Raster<Block> blocks_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double spacing_ = 0.05;
};

}  // namespace nadir::simulation
