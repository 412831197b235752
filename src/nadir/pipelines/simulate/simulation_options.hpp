// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/options.hpp"
#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_flight.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir {

/// All that a simulated site depends on besides its seed.
struct SimulationOptions {
  WorldOptions world;
  Appearance at_flight = flight_appearance();
  FlightOptions flight;
  Appearance at_drive = drive_appearance();
  RouteOptions route;
  StereoOptions stereo;
  LidarOptions lidar;
};

inline void declare(OptionTable& table, SimulationOptions& options) {
  declare(table, options.world);
  declare(table, "flight", options.at_flight);
  declare(table, options.flight);
  declare(table, "drive", options.at_drive);
  declare(table, options.route);
  declare(table, options.stereo);
  declare(table, options.lidar);
}

}  // namespace nadir
