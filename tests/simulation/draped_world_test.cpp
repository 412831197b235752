// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/simulation/scene/scene.hpp"
#include "nadir/simulation/simulated_drive.hpp"
#include "nadir/simulation/simulated_world.hpp"
#include "simulation/small_world.hpp"

namespace nadir {
namespace {

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

TEST(DrapedWorld, LiesWhereItsMapLies) {
  Orthomosaic map;
  map.geo = {700000.0, 6200000.0, 0.5, "a grid of zone 33 south"};
  map.image = Raster<std::uint8_t>(100, 80, 120);
  map.valid = Raster<std::uint8_t>(100, 80, 255);
  const SiteAnchor there = SimulatedWorld::drape(map, std::nullopt, 1, -33).anchor();
  EXPECT_DOUBLE_EQ(there.easting_m, 700000.0);
  EXPECT_DOUBLE_EQ(there.northing_m, 6199960.0);
  EXPECT_EQ(there.utm_zone, -33);
  EXPECT_EQ(there.crs, map.geo.crs);
  const SiteAnchor here = SimulatedWorld::drape(map, std::nullopt, 1).anchor();
  EXPECT_DOUBLE_EQ(here.easting_m, SiteAnchor{}.easting_m);
  EXPECT_EQ(here.crs, SiteAnchor{}.crs);
}

constexpr double kSide = 60.0;  // metres

/// A map that shows waves, in pixels of 0.2 m.
Orthomosaic map_of_waves() {
  Orthomosaic map;
  map.geo = {500.0, 800.0, 0.2, {}};
  map.image = Raster<std::uint8_t>(300, 300);
  map.valid = Raster<std::uint8_t>(300, 300, 255);
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 300; ++column) {
      map.image.at(column, row) =
          static_cast<std::uint8_t>(120.0 + 60.0 * std::sin(0.08 * column) * std::cos(0.11 * row));
    }
  }
  return map;
}

/// How far a place lies within two roads of 8 m that meet at a corner, metres.
double within_roads(double x, double y) {
  const double upright = std::min(4.0 - std::abs(x - 12.0), std::min(y - 8.0, kSide - y));
  const double across = std::min(4.0 - std::abs(y - 12.0), std::min(x - 8.0, kSide - x));
  return std::max(upright, across);
}

/// Known on the roads alone.
Orthomosaic map_of_roads() {
  Orthomosaic map = map_of_waves();
  for (int row = 0; row < 300; ++row) {
    for (int column = 0; column < 300; ++column) {
      const double within = within_roads(0.2 * (column + 0.5), kSide - 0.2 * (row + 0.5));
      map.valid.at(column, row) = within > 0.0 ? 255 : 0;
    }
  }
  return map;
}

double length_of(const std::vector<Pose2>& route) {
  double length = 0.0;
  for (std::size_t i = 1; i < route.size(); ++i) {
    length += std::hypot(route[i].x - route[i - 1].x, route[i].y - route[i - 1].y);
  }
  return length;
}

TEST(DrapedWorld, IsDrivenWhereTheMapIsKnown) {
  const std::vector<Pose2> route = SimulatedWorld::drape(map_of_roads(), std::nullopt).routes()[0];
  EXPECT_GT(length_of(route), 80.0);  // two roads of 48 m from their corner, less both ends
  for (const Pose2& place : route) EXPECT_GT(within_roads(place.x, place.y), 1.0);
}

/// There is no lane to keep: the robot drives on the way itself.
TEST(DrapedWorld, TheRobotKeepsToTheWay) {
  const SimulatedWorld world = SimulatedWorld::drape(map_of_roads(), std::nullopt);
  RouteOptions route;
  route.frames = 90;
  const SimulatedDrive drive(world, world.seen(drive_appearance()), route, 7);
  for (int frame = 0; frame < drive.size(); ++frame) {
    const Eigen::Vector3d& at = drive.map_from_robot(frame).translation;
    EXPECT_GT(within_roads(at.x(), at.y()), 1.0) << frame;
  }
}

TEST(DrapedWorld, IsDrivenToAWallAndNoFarther) {
  ElevationMap surface{Raster<float>(60, 60, 5.0F), {500.0, 800.0, 1.0, {}}};
  for (int row = 0; row < 60; ++row) surface.height_m.at(35, row) = 8.0F;  // 35 .. 36 m from west
  const std::vector<Pose2> route = SimulatedWorld::drape(map_of_roads(), surface).routes()[0];
  EXPECT_GT(length_of(route), 55.0);
  for (const Pose2& place : route) EXPECT_LT(place.x, 33.5);
}

/// What lies farther off may be a valley; a cell may be larger than the map.
TEST(DrapedWorld, HeightsAreThoseUnderTheMap) {
  ElevationMap surface{Raster<float>(1, 1, 12.0F), {490.0, 810.0, 300.0, {}}};
  EXPECT_NEAR(SimulatedWorld::drape(map_of_waves(), surface).ground_height(30.0, 30.0), 0.0, 1e-6);
  surface = {Raster<float>(40, 40, -500.0F), {400.0, 900.0, 5.0, {}}};
  for (int row = 19; row < 34; ++row) {
    for (int column = 19; column < 34; ++column) surface.height_m.at(column, row) = 12.0F;
  }
  const SimulatedWorld level = SimulatedWorld::drape(map_of_waves(), surface);
  EXPECT_DOUBLE_EQ(level.anchor().altitude_m, 12.0);
  EXPECT_NEAR(level.ground_height(30.0, 30.0), 0.0, 1e-6);
}

TEST(DrapedWorld, IsDrivenAroundItsMiddleWhereAllIsFree) {
  const std::vector<Pose2> route = SimulatedWorld::drape(map_of_waves(), std::nullopt).routes()[0];
  EXPECT_NEAR(route.front().x, 15.0, 0.1);
  EXPECT_NEAR(route.front().y, 30.0, 0.1);
}

TEST(DrapedWorld, WithoutFreeGroundIsStillDriven) {
  Orthomosaic map = map_of_waves();
  map.valid = Raster<std::uint8_t>(300, 300, 0);
  EXPECT_GT(length_of(SimulatedWorld::drape(map, std::nullopt).routes()[0]), 80.0);
}

TEST(DrapedWorld, GoesOnAsItsMirrorImage) {
  const SimulatedScene seen =
      SimulatedWorld::drape(map_of_waves(), std::nullopt).seen(flight_appearance());
  const Orthomosaic inside = seen.true_orthomosaic({0.0, kSide, 0.2, {}}, 60, 300);
  const Orthomosaic outside = seen.true_orthomosaic({-12.0, kSide, 0.2, {}}, 60, 300);
  for (int row = 10; row < 290; row += 7) {
    for (int column = 2; column < 58; ++column) {
      ASSERT_NEAR(inside.image.at(column, row), outside.image.at(59 - column, row), 2);
    }
  }
}

/// A slope that is seen face on is not drawn out along the ray, not even at the horizon's height.
TEST(DrapedWorld, ASlopeIsSeenSharpAtTheHeightOfTheEye) {
  ElevationMap surface{Raster<float>(120, 120, 0.0F), {500.0, 800.0, 0.5, {}}};
  for (int row = 0; row < 120; ++row) {
    for (int column = 60; column < 120; ++column) {
      surface.height_m.at(column, row) = 0.5F * static_cast<float>(std::min(column - 60, 16));
    }
  }
  const auto terrain = simulation::drape_terrain(1, map_of_waves(), surface, {});
  const simulation::Scene scene(terrain, flight_appearance());
  for (const double slope : {-0.04, -0.001, 0.0, 0.001, 0.04}) {
    for (double y = 20.0; y < 40.0; y += 0.5) {
      const Eigen::Vector3d eye(20.0, y, 4.0);
      const Eigen::Vector3d direction(1.0, 0.0, slope);
      const simulation::RayHit hit = scene.caster().cast(eye, direction);
      ASSERT_EQ(hit.solid, simulation::RayHit::kGround);
      const Eigen::Vector3d met = eye + hit.t * direction;
      const Eigen::Vector3f seen = scene.colour(eye, direction, hit, 0.1);
      const Eigen::Vector3f there = scene.ground_colour(met.x(), met.y(), 0.1F);
      EXPECT_LT((seen - there).norm(), 0.02F * there.norm()) << slope << ", " << met.transpose();
    }
  }
}

}  // namespace
}  // namespace nadir
