// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/ground_mapping/grid/aggregator.hpp"
#include "nadir/ground_mapping/grid/elevation_grid.hpp"
#include "nadir/ground_mapping/grid/fuser.hpp"

namespace nadir::ground {

/// Forgets what rays have passed through (equation 10): a cell that stands higher than the line of
/// sight to ground seen behind it, in three frames since it was last confirmed. Returns how many.
int clear_seen_through(const Aggregator& cells, ElevationGrid& grid,
                       const Eigen::Vector3d& sensor_in_odom, Progress now);

}  // namespace nadir::ground
