// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/simulation/drive.hpp"
#include "nadir/simulation/world.hpp"

namespace nadir::simulation {

/// A car that stands on the road when the robot passes, and did not when the drone flew.
struct Car {
  Point2<frames::Map> middle;
  double yaw = 0.0;
  std::array<double, 3> colour{};  ///< RGB, 0 .. 255
};

/// The robot's local orthomosaic at a pose: robot frame, robot at the centre, RGB; degraded by
/// blur, exposure, noise and holes as `options` asks. `frame` picks the random numbers.
Orthomosaic view_from(const World& world, const std::vector<Car>& cars, const Pose2& map_from_robot,
                      const DriveOptions& options, std::uint64_t seed, int frame);

}  // namespace nadir::simulation
