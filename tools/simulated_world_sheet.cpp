// SPDX-License-Identifier: Apache-2.0
#include "simulated_world_sheet.hpp"

#include <algorithm>

#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_flight.hpp"

namespace nadir {
namespace {

constexpr std::uint64_t kSeed = 7;
constexpr int kGap = 8;
constexpr int kUpper = 408;  ///< height of the upper row
constexpr int kLower = 240;
constexpr int kWidth = 920;

/// The mean of blocks of 2 x 2 pixels.
Raster<std::uint8_t> halved(const Raster<std::uint8_t>& image) {
  Raster<std::uint8_t> half(image.width() / 2, image.height() / 2, 0, 3);
  for (int row = 0; row < half.height(); ++row) {
    for (int column = 0; column < half.width(); ++column) {
      for (int k = 0; k < 3; ++k) {
        int sum = 2;
        for (int i = 0; i < 4; ++i) sum += image.at(2 * column + i % 2, 2 * row + i / 2, k);
        half.at(column, row, k) = static_cast<std::uint8_t>(sum / 4);
      }
    }
  }
  return half;
}

/// Copies a picture; steps of 4 grey levels keep the file small and cannot be seen.
void paste(const Raster<std::uint8_t>& picture, int left, int top, Raster<std::uint8_t>& sheet) {
  for (int row = 0; row < picture.height(); ++row) {
    for (int column = 0; column < picture.width(); ++column) {
      if (!sheet.contains(left + column, top + row)) continue;
      for (int k = 0; k < 3; ++k) {
        const int value = std::min(255, (picture.at(column, row, k) + 2) / 4 * 4);
        sheet.at(left + column, top + row, k) = static_cast<std::uint8_t>(value);
      }
    }
  }
}

Raster<std::uint8_t> masked(const Orthomosaic& map) {
  Raster<std::uint8_t> image = map.image;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      if (map.valid.at(column, row) != 0) continue;
      for (int k = 0; k < 3; ++k) image.at(column, row, k) = 255;
    }
  }
  return image;
}

}  // namespace

Raster<std::uint8_t> draw_simulated_world_sheet() {
  const SimulatedWorld world = SimulatedWorld::make(kSeed, WorldOptions{});
  Raster<std::uint8_t> sheet(kWidth, kUpper + kGap + kLower, 255, 3);

  const SimulatedScene flown = world.seen(flight_appearance());
  FlightOptions flight_options;
  flight_options.height_m = 42.0;
  flight_options.image_width = 2 * 544;
  flight_options.image_height = 2 * kUpper;
  flight_options.focal_px = 850.0;
  const SimulatedFlight flight(world, flown, flight_options, kSeed);
  paste(halved(flight.render(flight.size() / 2).image), 0, 0, sheet);
  const int map_width = kWidth - 544 - kGap;
  const double resolution = world.depth_m() / kUpper;
  const double west = 0.5 * world.width_m() - 0.5 * map_width * resolution;
  paste(flown.true_orthomosaic({west, world.depth_m(), resolution, {}}, map_width, kUpper).image,
        544 + kGap, 0, sheet);

  StereoOptions stereo;
  const SimulatedDrive drive(world, world.seen(drive_appearance()), RouteOptions{}, kSeed, stereo);
  const int frame = drive.size() / 3;
  const StereoFrame pair = drive.stereo(frame);
  paste(halved(pair.left), 0, kUpper + kGap, sheet);
  paste(halved(pair.right), 320 + kGap, kUpper + kGap, sheet);
  LocalTruthOptions local;
  local.resolution_m = local.size_m / kLower;
  paste(masked(drive.true_local(frame, local).local), 640 + 2 * kGap, kUpper + kGap, sheet);
  return sheet;
}

}  // namespace nadir
