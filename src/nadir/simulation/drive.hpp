// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

struct DriveOptions {
  int frames = 60;             ///< 1 .. 5000; with step_m at most 500 m of travel
  double step_m = 0.8;         ///< travel between frames, 0 .. 20
  double local_size_m = 18.0;  ///< side of the square local map, 1 .. 60
  double local_resolution_m = 0.10;
  double hole_share = 0.3;       ///< of the local map's pixels, 0 .. 0.95
  double noise_grey = 6.0;       ///< standard deviation, 0 .. 100
  double blur_px = 0.8;          ///< standard deviation, local map's pixels, 0 .. 20
  double exposure_gain = 0.75;   ///< local grey = 255 gain (grey / 255)^gamma; 0.05 .. 4
  double odometry_drift = 0.03;  ///< odometry falls short of the distance by this share, -1 .. 1
  double exposure_gamma = 1.15;  ///< 0.2 .. 5
  int unseen_cars = 3;           ///< cars that came after the drone had flown, 0 .. 100
};

/// A seeded place, seen twice: by the drone (the map) and by the robot that drives through it.
struct SimulatedSite {
  Orthomosaic map;
  std::vector<Frame> frames;  ///< local maps with noise, holes, blur, another exposure; odometry
  Trajectory truth;           ///< map_from_robot, exact
};

/// A procedural orthomosaic (road with markings, worn asphalt, grass, shadows; RGB, 0.10 m per
/// pixel, 120 x 60 m or as long as the drive needs, with a ragged invalid border) and a drive along
/// its right lane, 0.5 s a frame. Local maps are square RGB with the robot at the centre; odometry
/// starts at the identity. The same seed and options give the same bytes.
/// Throws Error (usage) where an option is out of its range.
SimulatedSite simulate_drive(std::uint64_t seed, const DriveOptions& options);

}  // namespace nadir
