// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

LidarRig bare_rig() {
  LidarRig rig;
  rig.robot_from_lidar.translation.z() = 1.2;
  return rig;
}

LidarFrame flat(Stamp stamp) {
  LidarFrame frame = sweep_at(stamp);
  for (float x = -6.0F; x < 6.0F; x += 0.05F) {
    for (float y = -6.0F; y < 6.0F; y += 0.05F) frame.points.push_back({x, y, -1.2F});
  }
  return frame;
}

TEST(Robustness, EmptyFramesLeaveTheMapAsItIs) {
  GroundMapper mapper(bare_rig(), {});
  mapper.integrate(flat(Stamp{0}), {});
  const LocalMap before = mapper.render({});
  LidarFrame empty = sweep_at(Stamp{100});
  EXPECT_EQ(mapper.integrate(empty, {}).status, MappingStatus::kNoPoints);
  LidarFrame nothing = sweep_at(Stamp{200});
  nothing.points.assign(1000, LidarPoint{kNan, kNan, kNan});
  nothing.points.push_back({0.0F, 0.0F, 0.0F});
  const FrameStatistics s = mapper.integrate(nothing, {});
  EXPECT_EQ(s.status, MappingStatus::kNoPoints);
  EXPECT_EQ(s.dropped.no_disparity, 1001);
  EXPECT_FALSE(s.warnings.empty());
  const LocalMap after = mapper.render({});
  EXPECT_EQ(before.ortho.valid, after.ortho.valid);
  ASSERT_TRUE(after.ground_in_odom_m.has_value());
  EXPECT_NEAR(*after.ground_in_odom_m, 0.0, 1e-3);
}

TEST(Robustness, OnePointIsEnoughForOneCell) {
  GroundMapper mapper(bare_rig(), {});
  LidarFrame frame = sweep_at(Stamp{0});
  frame.points.push_back({2.0F, 0.0F, -1.2F});
  const FrameStatistics s = mapper.integrate(frame, {});
  EXPECT_EQ(s.cells_new, 1);
  EXPECT_TRUE(std::isnan(s.innovation_median_m));
  const LocalMap map = mapper.render({});
  EXPECT_TRUE(map.low_coverage);
  EXPECT_FALSE(map.ground_in_odom_m.has_value());
}

TEST(Robustness, EveryDroppedPointHasAReason) {
  GroundMappingOptions options;
  options.grid_cells = 64;  // 6.4 m
  GroundMapper mapper(bare_rig(), options);
  LidarFrame frame = sweep_at(Stamp{0});
  frame.points = {{kNan, 0.0F, 0.0F},  {0.5F, 0.0F, 0.0F}, {50.0F, 0.0F, -1.2F},
                  {2.0F, 0.0F, -5.0F}, {2.0F, 0.0F, 1.0F}, {5.0F, 0.0F, -1.2F},
                  {2.0F, 0.03F, -1.2F}};
  const FrameStatistics s = mapper.integrate(frame, {});
  EXPECT_EQ(s.points_in, 7);
  EXPECT_EQ(s.dropped.no_disparity, 1);
  EXPECT_EQ(s.dropped.range, 2);
  EXPECT_EQ(s.dropped.height, 2);
  EXPECT_EQ(s.dropped.outside, 1);
  EXPECT_EQ(s.cells_new, 1);
}

TEST(Robustness, APoseThatJumpsDropsTheMap) {
  GroundMapper mapper(bare_rig(), {});
  for (int i = 0; i < 3; ++i) {
    EXPECT_FALSE(mapper.integrate(flat(at_step(i)), pose_at(0.5 * i, 0.0, 0.0)).map_dropped);
  }
  // Braking within what a robot can do is no jump.
  EXPECT_FALSE(mapper.integrate(flat(at_step(3)), pose_at(1.3, 0.0, 0.0)).map_dropped);
  const FrameStatistics moved = mapper.integrate(flat(at_step(4)), pose_at(3.3, 0.0, 0.0));
  EXPECT_TRUE(moved.map_dropped);
  ASSERT_FALSE(moved.warnings.empty());
  EXPECT_NE(moved.warnings.front().find("the pose jumped by"), std::string::npos);
  EXPECT_GT(moved.cells_new, 1000) << "the map begins anew with this frame";
  mapper.integrate(flat(at_step(5)), pose_at(3.5, 0.0, 0.0));
  EXPECT_TRUE(mapper.integrate(flat(at_step(6)), pose_at(3.7, 0.0, 0.3)).map_dropped);
}

TEST(Robustness, WallsAreLeftOutOfTheGround) {
  GroundMapper mapper(bare_rig(), {});
  LidarFrame frame = flat(Stamp{0});
  for (LidarPoint& p : frame.points) {
    if (p.x > 3.0F && p.x < 4.0F) p.z = 0.3F;  // 1.5 m over the ground
  }
  mapper.integrate(frame, {});
  const auto height_at = [&](bool ground_only, double x) {
    const LocalMap map = mapper.render({.ground_only = ground_only});
    const auto p = map.ortho.geo.pixel_at(x, 0.05);
    return map.elevation.height_m.at(static_cast<int>(p.column), static_cast<int>(p.row));
  };
  EXPECT_NEAR(height_at(false, 3.55), 1.5F, 0.01F);
  EXPECT_TRUE(std::isnan(height_at(true, 3.55)));
  EXPECT_NEAR(height_at(true, 2.05), 0.0F, 0.01F);
}

TEST(Robustness, ABankedRoadIsGround) {
  // The road is banked by 12 degrees: 1.2 m at the edge of the map.
  const OdomPose3 banked{
      Eigen::Quaterniond(Eigen::AngleAxisd(radians(12.0), Eigen::Vector3d::UnitX())),
      Eigen::Vector3d::Zero()};
  GroundMapper mapper(bare_rig(), {});
  mapper.integrate(flat(Stamp{0}), banked);
  const LocalMap map = mapper.render({.size_x_m = 4.0, .size_y_m = 11.0});
  int known = 0;
  for (const float h : map.elevation.height_m.values()) known += std::isnan(h) ? 0 : 1;
  EXPECT_GT(known, 0.97 * 40 * 110);
}

TEST(Robustness, LocalMapsAreLaidOutAroundTheRobot) {
  GroundMapper mapper(bare_rig(), {});
  mapper.integrate(flat(Stamp{7}), pose_at(100.04, 50.0, 0.5));
  const LocalMap map = mapper.render({.size_x_m = 6.0, .size_y_m = 4.0, .resolution_m = 0.05});
  EXPECT_EQ(map.stamp.nanoseconds, 7);
  EXPECT_EQ(map.ortho.width(), 120);
  EXPECT_EQ(map.ortho.height(), 80);
  EXPECT_DOUBLE_EQ(map.ortho.geo.west, -3.0);
  EXPECT_DOUBLE_EQ(map.ortho.geo.north, 2.0);
  const LocalMap coarse = mapper.render({.size_x_m = 6.0, .size_y_m = 4.0, .resolution_m = 0.5});
  EXPECT_EQ(coarse.ortho.width(), 12);
  EXPECT_NEAR(coarse.elevation.height_m.at(6, 4), 0.0F, 1e-3F);
  const LocalMap upright = mapper.render({.up = MapUp::kOdom});
  // Pixels are cells: the corner lies on a multiple of the resolution.
  EXPECT_NEAR(std::remainder(upright.ortho.geo.west + 100.04, 0.1), 0.0, 1e-9);
  EXPECT_NEAR(upright.ortho.geo.west, -9.0, 0.06);
}

}  // namespace
}  // namespace nadir::test
