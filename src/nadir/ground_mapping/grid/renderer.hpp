// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "nadir/ground_mapping/grid/elevation_grid.hpp"
#include "nadir/ground_mapping/local_map.hpp"

namespace nadir::ground {

/// The plane that the robot stands on: z = height + slope_x x + slope_y y, with (x, y) in the axes
/// of the odometry frame from the robot.
struct GroundPlane {
  double height = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;

  double at(double x, double y) const { return height + slope_x * x + slope_y * y; }
};

/// Fitted to the cells around the robot in the strip that it drives along, without those that stand
/// out of it; nothing where too few are known within 12 m. A slope is at most 30 %.
std::optional<GroundPlane> ground_plane(const ElevationGrid& grid,
                                        const OdomPose3& odom_from_robot);

/// The height of an unknown cell, interpolated along x and y across gaps of at most `fill_cells`
/// cells that are bounded on both sides; nothing elsewhere.
std::optional<float> filled_height(const ElevationGrid& grid, CellIndex index, int fill_cells);

/// Samples the grid under the pixels of a local map: bilinear, where known cells have at least half
/// of the weight; the mean over a pixel that is larger than a cell. `channels` is 1 or 3.
LocalMap render(const ElevationGrid& grid, const OdomPose3& odom_from_robot,
                const RenderOptions& options, int channels, int fill_cells);

}  // namespace nadir::ground
