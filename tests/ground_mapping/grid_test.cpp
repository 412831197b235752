// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/elevation_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ground_mapping/scene.hpp"
#include "nadir/core/random.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir::test {
namespace {

using ground::CellIndex;
using ground::ElevationGrid;

TEST(Grid, RemembersWhatStaysAndForgetsWhatLeaves) {
  ElevationGrid grid(0.1, 32);
  // Against a plain list of what lies where, over random moves.
  std::vector<std::pair<CellIndex, float>> expected;
  const RandomStream random(1, 1);
  CellIndex centre{-5, 7};
  for (std::uint64_t step = 0; step < 300; ++step) {
    const auto draw = random.uniform_pair(2 * step);
    const double reach = step % 20 == 19 ? 100.0 : 6.0;
    centre.x += std::lround((draw[0] - 0.5) * reach);
    centre.y += std::lround((draw[1] - 0.4) * reach);
    grid.centre_on(centre);
    std::erase_if(expected, [&](const auto& e) { return !grid.contains(e.first); });
    const auto place = random.uniform_pair(2 * step + 1);
    const CellIndex index{grid.origin().x + static_cast<std::int64_t>(place[0] * 32),
                          grid.origin().y + static_cast<std::int64_t>(place[1] * 32)};
    grid.at(index).height = static_cast<float>(step);
    std::erase_if(expected,
                  [&](const auto& e) { return e.first.x == index.x && e.first.y == index.y; });
    expected.emplace_back(index, static_cast<float>(step));
    std::size_t known = 0;
    for (int x = 0; x < 32; ++x) {
      for (int y = 0; y < 32; ++y) {
        known += grid.at(CellIndex{grid.origin().x + x, grid.origin().y + y}).known() ? 1U : 0U;
      }
    }
    ASSERT_EQ(known, expected.size()) << step;
    for (const auto& [i, height] : expected) ASSERT_EQ(grid.at(i).height, height);
  }
}

TEST(Grid, CellsOfNegativeCoordinatesAreFloored) {
  const ElevationGrid grid(0.1, 32);
  EXPECT_EQ(grid.index_of(-0.01, 0.01).x, -1);
  EXPECT_EQ(grid.index_of(-0.01, 0.01).y, 0);
  EXPECT_EQ(grid.index_of(-0.35, 0.0).x, -4);
  EXPECT_EQ(grid.find({-1, 0}), nullptr);
}

/// A drive of 80 m over points around the robot, through a window of 12.8 m.
TEST(Grid, TheRollingWindowEqualsAFixedMap) {
  GroundMappingOptions options;
  options.resolution_m = 0.2;
  options.lidar_max_range_m = 6.0;
  options.colour_rule = ColourRule::kMean;
  GroundMappingOptions fixed = options;
  options.grid_cells = 64;
  fixed.grid_cells = 1024;
  Scene scene;
  scene.kerb_y = 1.0;
  scene.kerb_height = 0.12;
  const LidarRig rig = make_lidar_rig();
  GroundMapper rolling(rig, options), whole(rig, fixed);
  const RandomStream random(3, 1);
  for (int i = 0; i < 80; ++i) {
    const OdomPose3 pose = pose_at(-40.0 + 1.0 * i, 0.3 * i, 0.02 * i);
    LidarFrame frame;
    frame.stamp = Stamp{1'000'000'000LL * i};
    const auto lidar_from_odom = (pose * rig.robot_from_lidar).inverse();
    for (std::uint64_t k = 0; k < 1500; ++k) {
      const auto draw = random.uniform_pair(static_cast<std::uint64_t>(i) * 1500 + k);
      const auto p = planar(pose) * Point2<frames::Robot>{8.0 * draw[0] - 3.0, 8.0 * draw[1] - 4.0};
      const auto hit = lidar_from_odom * Point3<frames::Odom>{p.x, p.y, scene.ground(p.x, p.y)};
      frame.points.push_back(
          {static_cast<float>(hit.x), static_cast<float>(hit.y), static_cast<float>(hit.z)});
    }
    frame.images.push_back(Raster<std::uint8_t>(320, 240, static_cast<std::uint8_t>(50 + i)));
    rolling.integrate(frame, pose);
    whole.integrate(frame, pose);
    if (i % 8 != 7) continue;
    const RenderOptions rendering{.size_x_m = 8.0,
                                  .size_y_m = 8.0,
                                  .resolution_m = 0.2,
                                  .up = i % 16 == 7 ? MapUp::kOdom : MapUp::kRobot};
    const LocalMap a = rolling.render(rendering), b = whole.render(rendering);
    EXPECT_GT(a.coverage, 0.1);
    EXPECT_EQ(a.ortho.image, b.ortho.image) << i;
    EXPECT_EQ(a.ortho.valid, b.ortho.valid) << i;
    EXPECT_EQ(a.weight, b.weight) << i;
    for (std::size_t c = 0; c < a.elevation.height_m.values().size(); ++c) {
      const float x = a.elevation.height_m.values()[c], y = b.elevation.height_m.values()[c];
      ASSERT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << i;
    }
  }
}

}  // namespace
}  // namespace nadir::test
