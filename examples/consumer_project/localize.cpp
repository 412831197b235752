// SPDX-License-Identifier: Apache-2.0
// Uses nadir::nadir: localizes a short simulated drive and says how far off the end is.
#include <cmath>
#include <iostream>

#include "nadir/localizer.hpp"
#include "nadir/simulation/simulated_drive.hpp"

int main() {
  nadir::WorldOptions place;
  place.width_m = 60.0;
  place.depth_m = 50.0;
  place.margin_m = 5.0;
  const auto world = nadir::SimulatedWorld::make(7, place);
  const nadir::Orthomosaic map = world.seen(nadir::flight_appearance())
                                     .true_orthomosaic({0.0, place.depth_m, 0.10, {}}, 600, 500);
  nadir::RouteOptions route;
  route.frames = 5;
  const nadir::SimulatedDrive drive(world, world.seen(nadir::drive_appearance()), route, 7);

  nadir::Localizer localizer{map, nadir::LocalizerOptions{}, 1};
  localizer.start_near(nadir::planar(drive.map_from_robot(0)),
                       {.position_m = 1.0, .yaw_rad = 0.02});
  nadir::Estimate estimate;
  for (int frame = 0; frame < drive.size(); ++frame) {
    estimate = localizer.update(drive.true_local(frame, {.only_seen = false}));
  }

  const nadir::Pose2 truth = nadir::planar(drive.map_from_robot(drive.size() - 1));
  const double error_m =
      std::hypot(estimate.map_from_robot.x - truth.x, estimate.map_from_robot.y - truth.y);
  std::cout << "off by " << error_m << " m after " << drive.size() << " frames\n";
  return error_m < 1.0 ? 0 : 1;
}
