// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/ground.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "nadir/core/random.hpp"

namespace nadir::aerial {
namespace {

std::vector<Eigen::Vector3d> points_on(double (*height)(double, double), int count) {
  const RandomStream random(3, 1);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const auto [a, b] = random.uniform_pair(static_cast<std::uint64_t>(i));
    points.emplace_back(40.0 * a, 30.0 * b, height(40.0 * a, 30.0 * b));
  }
  return points;
}

double slope(double x, double y) { return 5.0 + 0.2 * x - 0.1 * y; }
double hill(double x, double y) { return 2.0 * std::sin(x / 8.0) * std::cos(y / 9.0); }

TEST(Ground, TrianglesGiveASlopeExactly) {
  const Ground ground = triangulated_ground(points_on(slope, 2000), {0, 0, 40, 30}, 0.4);
  for (double x = 4.0; x < 36.0; x += 1.7)
    for (double y = 4.0; y < 26.0; y += 1.3)
      // One point a cell, its own height at the cell's corner: half a cell of slope at most.
      EXPECT_NEAR(ground.height_at(x, y), slope(x, y), 0.02) << x << " " << y;
}

TEST(Ground, TrianglesFollowAHill) {
  const Ground ground = triangulated_ground(points_on(hill, 4000), {0, 0, 40, 30}, 0.4);
  double sum = 0.0;
  int count = 0;
  for (double x = 3.0; x < 37.0; x += 0.9)
    for (double y = 3.0; y < 27.0; y += 0.9, ++count)
      sum += std::pow(ground.height_at(x, y) - hill(x, y), 2);
  EXPECT_LT(std::sqrt(sum / count), 0.05);
}

TEST(Ground, DistanceIsThatToTheNearestPoint) {
  std::vector<Eigen::Vector3d> points = points_on(slope, 3000);
  std::erase_if(points, [](const auto& p) { return std::hypot(p.x() - 20, p.y() - 15) < 8.0; });
  const Ground ground = triangulated_ground(points, {0, 0, 40, 30}, 0.4);
  EXPECT_NEAR(ground.distance_at(20.0, 15.0), 8.0, 0.7);
  EXPECT_LT(ground.distance_at(35.0, 25.0), 1.0);
}

TEST(Ground, OutliersGoAndStepsStay) {
  std::vector<Eigen::Vector3d> points =
      points_on([](double x, double) { return x > 20.0 ? 6.0 : 0.0; }, 3000);  // a roof
  const std::size_t real = points.size();
  points.emplace_back(10.0, 15.0, 12.0);
  points.emplace_back(30.0, 15.0, -9.0);
  const auto kept = without_outliers(points, 0.4);
  EXPECT_GT(kept.size(), real * 97 / 100);
  for (const Eigen::Vector3d& p : kept) EXPECT_LT(std::abs(p.z() - 3.0), 3.5);
}

double block(double x, double y) {
  return std::abs(x - 20.0) < 5.0 && std::abs(y - 15.0) < 4.0 ? 6.0 : 0.0;
}

TEST(Ground, TheFootOfAWallIsNotLifted) {
  std::vector<Eigen::Vector3d> points = points_on(block, 4000);
  // Shadow and lean leave no points on the ground within 2 m of the walls.
  std::erase_if(points, [](const auto& p) {
    return p.z() == 0.0 && std::abs(p.x() - 20.0) < 7.0 && std::abs(p.y() - 15.0) < 6.0;
  });
  const Ground ground = triangulated_ground(points, {0, 0, 40, 30}, 0.4);
  for (const double away : {0.7, 1.2, 1.7}) {
    EXPECT_NEAR(ground.height_at(25.0 + away, 15.0), 0.0, 0.01) << away;
    EXPECT_NEAR(ground.height_at(20.0, 11.0 - away), 0.0, 0.01) << away;
    EXPECT_GT(ground.ramp_at(25.0 + away, 15.0), 0.5) << away;
  }
  EXPECT_NEAR(ground.height_at(20.0, 15.0), 6.0, 0.01);
}

TEST(Ground, GoesOnBeyondThePointsWhereTheyAreLevel) {
  const auto beyond = [](double (*height)(double, double)) {
    std::vector<Eigen::Vector3d> points = points_on(height, 4000);
    std::erase_if(points, [](const auto& p) { return p.x() > 22.0; });
    points.emplace_back(22.0, 5.0, -4.0);  // one wrong point at the rim
    return triangulated_ground(points, {0, 0, 40, 30}, 0.4);
  };
  const Ground level = beyond([](double, double) { return 1.0; });
  EXPECT_NEAR(level.height_at(24.0, 5.0), 1.0, 0.05);
  EXPECT_TRUE(level.is_known_at(24.0, 25.0, 4.0));
  // A block at the rim: nobody knows how far it reaches.
  const Ground rim = beyond(block);
  EXPECT_FALSE(rim.is_known_at(24.0, 15.0, 4.0));
  EXPECT_TRUE(rim.is_known_at(24.0, 28.0, 4.0));
}

TEST(Ground, PlaneIgnoresWhatStandsOnIt) {
  std::vector<Eigen::Vector3d> points = points_on(slope, 500);
  for (std::size_t i = 0; i < points.size(); i += 5) points[i].z() += 8.0;
  const Ground ground = plane_ground(points, {0, 0, 40, 30}, 0.5, 0.0);
  EXPECT_NEAR(ground.height_at(10.0, 10.0), slope(10.0, 10.0), 0.1);
  EXPECT_NEAR(ground.height_at(38.0, 3.0), slope(38.0, 3.0), 0.1);
  EXPECT_DOUBLE_EQ(ground.distance_at(10.0, 10.0), 0.0);
  EXPECT_NEAR(plane_ground({}, {0, 0, 4, 4}, 0.5, 7.0).height_at(2, 2), 7.0, 1e-6);
}

}  // namespace
}  // namespace nadir::aerial
