// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/simulation/scene/scene.hpp"
#include "nadir/simulation/simulated_drive.hpp"

namespace nadir::simulation {

/// The motion of the robot while a lidar turns: from `begin` towards `next` in `seconds`.
struct Sweep {
  Transform3<frames::Map, frames::Robot> begin;
  Transform3<frames::Map, frames::Robot> next;
  double seconds = 0.1;
};

/// One turn of a lidar, ring by ring from below, each point in the lidar's frame at its own time.
/// What is out of range, met nothing or dropped out is left out.
std::vector<LidarPoint> scan(const Scene& scene, const Sweep& sweep, const LidarRig& rig,
                             const LidarOptions& options, std::uint64_t seed, std::uint64_t stream,
                             const Movers& movers);

}  // namespace nadir::simulation
