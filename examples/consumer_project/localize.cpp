// SPDX-License-Identifier: Apache-2.0
// Uses nadir::nadir: localizes a short simulated drive and says how far off the end is.
#include <cmath>
#include <iostream>

#include "nadir/localizer.hpp"
#include "nadir/simulation/drive.hpp"

int main() {
  nadir::DriveOptions drive;
  drive.frames = 5;
  const nadir::SimulatedSite site = nadir::simulate_drive(7, drive);

  nadir::Localizer localizer{site.map, nadir::LocalizerOptions{}, 1};
  localizer.start_near(site.truth.front().pose, {.position_m = 1.0, .yaw_rad = 0.02});
  nadir::Estimate estimate;
  for (const nadir::Frame& frame : site.frames) estimate = localizer.update(frame);

  const nadir::Pose2& truth = site.truth.back().pose;
  const double error_m =
      std::hypot(estimate.map_from_robot.x - truth.x, estimate.map_from_robot.y - truth.y);
  std::cout << "off by " << error_m << " m after " << site.frames.size() << " frames\n";
  return error_m < 1.0 ? 0 : 1;
}
