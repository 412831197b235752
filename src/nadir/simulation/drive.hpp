// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

struct DriveOptions {
  int frames = 60;
  double step_m = 0.8;  ///< travel between frames
  double local_size_m = 18.0;
  double local_resolution_m = 0.10;
  double hole_share = 0.3;
  double noise_grey = 6.0;  ///< standard deviation
  double blur_px = 0.8;
  double exposure_gain = 0.75;
  double odometry_drift = 0.03;  ///< relative error of the distance
};

/// A seeded place, seen twice: by the drone (the map) and by the robot that drives through it.
struct SimulatedSite {
  Orthomosaic map;
  std::vector<Frame> frames;  ///< local maps with noise, holes, blur, another exposure; odometry
  Trajectory truth;           ///< map_from_robot, exact
};

/// A procedural orthomosaic (road with markings, worn asphalt, grass, shadows) and a drive over it.
/// The same seed gives the same bytes.
SimulatedSite simulate_drive(std::uint64_t seed, const DriveOptions& options);

}  // namespace nadir
