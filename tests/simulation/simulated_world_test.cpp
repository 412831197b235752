// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_world.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "nadir/core/error.hpp"
#include "simulation/small_world.hpp"

namespace nadir {
namespace {

const SimulatedWorld& world() {
  static const SimulatedWorld kWorld = SimulatedWorld::make(3, test::small_world());
  return kWorld;
}

const SimulatedScene& noon() {
  static const SimulatedScene kScene = world().seen(flight_appearance());
  return kScene;
}

TEST(SimulatedWorld, IsTheSameForAnyNumberOfThreads) {
  const GeoReference geo{20.0, 50.0, 0.2, {}};
  const auto bytes = [&](std::size_t threads, std::uint64_t seed) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const SimulatedWorld made = SimulatedWorld::make(seed, test::small_world());
    return made.seen(flight_appearance()).true_orthomosaic(geo, 150, 120).image;
  };
  const Raster<std::uint8_t> one = bytes(1, 3);
  EXPECT_EQ(one, bytes(4, 3));
  EXPECT_NE(one, bytes(4, 4));
}

TEST(SimulatedWorld, SurfaceIsWhereRaysMeetIt) {
  // From a slanted ray's end back up: the surface passes through the point that it met.
  for (int i = 0; i < 200; ++i) {
    const double x = 10.0 + 0.35 * i;
    const double y = 8.0 + 0.27 * i;
    const double height = noon().surface_height(x, y);
    EXPECT_GE(height, world().ground_height(x, y) - 1e-3);
    EXPECT_TRUE(noon().sees({x, y, 100.0}, {x, y, height + 0.01}));
    EXPECT_FALSE(noon().sees({x, y, 100.0}, {x, y, height - 0.01}));
  }
}

TEST(SimulatedWorld, KerbsAreTwelveCentimetresHigh) {
  // Across the street at a place of the route that is straight: the lowest lies in the gutter,
  // right beside the kerb's top.
  const auto route = world().routes().front();
  int kerbs = 0;
  for (std::size_t i = 10; i < route.size(); i += 7) {
    const Pose2& at = route[i];
    double step = 0.0;
    for (double across = -4.6; across < -2.6; across += 0.02) {
      const auto inner = at * Point2<frames::Robot>{0.0, across + 0.2};
      const auto outer = at * Point2<frames::Robot>{0.0, across};
      step = std::max(
          step, world().ground_height(outer.x, outer.y) - world().ground_height(inner.x, inner.y));
    }
    if (step > 0.1 && step < 0.18) ++kerbs;
  }
  EXPECT_GE(kerbs, 8);
}

TEST(SimulatedWorld, TheTwoVisitsDiffer) {
  const SimulatedScene later = world().seen(drive_appearance());
  const GeoReference geo{0.0, 70.0, 0.25, {}};
  const ElevationMap before = noon().true_surface(geo, 360, 280);
  const ElevationMap after = later.true_surface(geo, 360, 280);
  int moved = 0;
  for (std::size_t i = 0; i < before.height_m.values().size(); ++i) {
    if (std::abs(before.height_m.values()[i] - after.height_m.values()[i]) > 0.5F) ++moved;
  }
  // Some parked cars of about 8 m^2 each, and nothing else, stand elsewhere.
  EXPECT_GT(moved * 0.0625, 15.0);
  EXPECT_LT(moved * 0.0625, 400.0);
}

TEST(SimulatedWorld, OptionsAreChecked) {
  WorldOptions options = test::small_world();
  options.texel_m = 0.0;
  EXPECT_THROW(SimulatedWorld::make(1, options), Error);
}

TEST(DrapedWorld, ShowsTheMapThatItWasGiven) {
  Orthomosaic map;
  map.geo = {1000.0, 2000.0, 0.1, {}};
  map.image = Raster<std::uint8_t>(200, 150, 0, 3);
  map.valid = Raster<std::uint8_t>(200, 150, 255);
  for (int row = 0; row < 150; ++row) {
    for (int column = 0; column < 200; ++column) {
      for (int k = 0; k < 3; ++k) {
        map.image.at(column, row, k) = static_cast<std::uint8_t>(
            128.0 + 60.0 * std::sin(0.11 * column + 0.4 * k) * std::cos(0.07 * row));
      }
    }
  }
  ElevationMap surface{Raster<float>(20, 15, 30.0F), {1000.0, 2000.0, 1.0, {}}};
  for (const int i : {4, 5, 6}) {
    for (const int j : {4, 5, 6}) surface.height_m.at(i, j) = 33.0F;
  }
  ElevationMap elsewhere = surface;
  elsewhere.geo.west += 80000.0;
  EXPECT_THROW(SimulatedWorld::drape(map, elsewhere, 1), Error);
  const SimulatedWorld draped = SimulatedWorld::drape(map, surface);
  EXPECT_NEAR(draped.ground_height(5.5, 15.0 - 5.5), 3.0, 1e-3);
  EXPECT_NEAR(draped.ground_height(14.0, 3.0), 0.0, 1e-6);
  EXPECT_DOUBLE_EQ(draped.anchor().easting_m, 1000.0);
  const Orthomosaic seen =
      draped.seen(flight_appearance()).true_orthomosaic({0.0, 15.0, 0.1, {}}, 200, 150);
  std::vector<double> given;
  std::vector<double> shown;
  for (int row = 100; row < 145; ++row) {
    for (int column = 100; column < 195; ++column) {
      given.push_back(map.image.at(column, row, 1));
      shown.push_back(seen.image.at(column, row, 1));
    }
  }
  EXPECT_GT(test::zncc(given, shown), 0.99);
}

}  // namespace
}  // namespace nadir
