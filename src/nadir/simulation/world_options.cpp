// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <utility>

#include "nadir/simulation/simulated_world.hpp"

namespace nadir {
namespace {

constexpr std::array<std::pair<WorldPreset, const char*>, 3> kPresetNames{
    {{WorldPreset::kCampus, "campus"},
     {WorldPreset::kParking, "parking"},
     {WorldPreset::kFarm, "farm"}}};

}  // namespace

Appearance flight_appearance() { return {}; }

Appearance drive_appearance() {
  Appearance later;
  later.sun_heading_deg = 236.0;
  later.sun_elevation_deg = 40.0;
  later.dryness = 0.45;
  later.traffic_seed = 2;
  return later;
}

void declare(OptionTable& table, WorldOptions& options) {
  const std::string part = "simulation.";
  table.choice<WorldPreset>(part + "preset", options.preset, kPresetNames,
                            "What kind of place is made.");
  table.number(part + "width_m", options.width_m, {40.0, 1000.0},
               "Extent of the site from west to east, metres.");
  table.number(part + "depth_m", options.depth_m, {40.0, 1000.0},
               "Extent of the site from south to north, metres.");
  table.number(part + "margin_m", options.margin_m, {0.0, 100.0},
               "Width of the world in full detail around the site, metres.");
  table.number(part + "relief_m", options.relief_m, {0.0, 10.0},
               "Amplitude of the hills, metres; 0 = level ground.");
  table.number(part + "texel_m", options.texel_m, {0.02, 0.5},
               "Grid of the stored ground, metres; near a drive it is drawn twice as fine.");
}

void declare(OptionTable& table, const std::string& name, Appearance& appearance) {
  const std::string part = "simulation." + name + "_";
  table.number(part + "sun_heading_deg", appearance.sun_heading_deg, {-360.0, 360.0},
               "Where the sun stands, degrees clockwise from north.");
  table.number(part + "sun_elevation_deg", appearance.sun_elevation_deg, {5.0, 90.0},
               "Height of the sun above the horizon, degrees.");
  table.number(part + "dryness", appearance.dryness, {0.0, 1.0},
               "Tint of all plants: 0 = fresh green, 1 = straw.");
  table.number(part + "car_share", appearance.car_share, {0.0, 1.0},
               "Share of the parking places that are taken.");
  table.number(part + "cars_per_km", appearance.cars_per_km, {0.0, 200.0},
               "Cars under way on a kilometre of street, both directions together.");
}

void check(WorldOptions& options) {
  OptionTable table;
  declare(table, options);
  for (const Option& option : table.options()) option.set(option.get());
}

}  // namespace nadir
