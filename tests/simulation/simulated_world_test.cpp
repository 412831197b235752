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

}  // namespace
}  // namespace nadir
