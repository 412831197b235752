// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/ortho/views.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Where features gave no ground, heights are tried until the photos agree (plane sweep, Collins
/// 1996): places on a grid of 2 % of the flying height that are not known, at which three photos or
/// more show the same patch at one height and at no other. Gives these points.
std::vector<Eigen::Vector3d> sweep_gaps(const std::vector<View>& views, ViewImages& images,
                                        const Ground& ground, const ViewLimits& limits,
                                        double max_distance_m, const StopToken& stop);

}  // namespace nadir::aerial
