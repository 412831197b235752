// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "nadir/ground_mapping/grid/elevation_grid.hpp"
#include "nadir/ground_mapping/local_map.hpp"

namespace nadir::ground {

/// The height of the ground where the robot stands: the median over the cells nearest to it in the
/// strip that it drives along; nothing where none is known within 12 m.
std::optional<double> ground_height(const ElevationGrid& grid, const OdomPose3& odom_from_robot);

/// The height of an unknown cell, interpolated along x and y across gaps of at most `fill_cells`
/// cells that are bounded on both sides; nothing elsewhere.
std::optional<float> filled_height(const ElevationGrid& grid, CellIndex index, int fill_cells);

/// Samples the grid under the pixels of a local map: bilinear over the cells that are known, where
/// the nearest one is; the mean over a pixel that is larger than a cell. `channels` is 1 or 3.
LocalMap render(const ElevationGrid& grid, const OdomPose3& odom_from_robot,
                const RenderOptions& options, int channels, int fill_cells);

}  // namespace nadir::ground
