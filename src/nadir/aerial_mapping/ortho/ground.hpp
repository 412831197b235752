// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/raster.hpp"

namespace nadir::aerial {

/// The area of a map, metres.
struct Extent {
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
};

/// What the photos are projected on: a height everywhere in the extent.
///
/// Walls and the rims of crowns are steps, with points on top and at the foot and none between, and
/// the points at the foot lie farther from the step. A ramp between them would lift the ground at
/// the foot, and shift what is seen of it: a steep triangle has the height of its lowest corner.
struct Ground {
  ElevationMap heights;      ///< without holes
  Raster<float> ramp_m;      ///< same grid: the heights with ramps in place of steps
  Raster<float> distance_m;  ///< same grid: to the nearest point that the heights come from
  Raster<float> span_m;      ///< longest side of the triangle of points there; 1e6 beyond them
  double height_at(double x, double y) const;
  double ramp_at(double x, double y) const;
  double distance_at(double x, double y) const;
  /// Whether the ground is known in a cell: near a point, or between points that are no farther
  /// apart than four times as much.
  bool is_known(int column, int row, double max_distance_m) const;
  bool is_known_at(double x, double y, double max_distance_m) const;
};

/// Points that stand out from their neighbours by more than these usually scatter, or than
/// `tolerance_m` where that is more, are left out.
std::vector<Eigen::Vector3d> without_outliers(std::vector<Eigen::Vector3d> points,
                                              double tolerance_m);

/// Points -> Delaunay triangles -> grid, median of 3 x 3. Beyond the
/// triangles the nearest height goes on. Needs three points that are not on a line, else the plane.
Ground triangulated_ground(const std::vector<Eigen::Vector3d>& points, const Extent& extent,
                           double cell_m);

/// z = a + b x + c y fitted robustly to the points; level at `fallback` with fewer than three.
/// Distances are zero: a plane is everywhere.
Ground plane_ground(const std::vector<Eigen::Vector3d>& points, const Extent& extent, double cell_m,
                    double fallback);

}  // namespace nadir::aerial
