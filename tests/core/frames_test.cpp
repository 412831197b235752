// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/frames.hpp"

#include <gtest/gtest.h>

#include "nadir/core/random.hpp"

namespace nadir {
namespace {

template <class To, class From>
void expect_same(const Transform2<To, From>& a, const Transform2<To, From>& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(wrap_angle(a.yaw - b.yaw), 0.0, 1e-12);
}

Pose2 random_pose(std::uint64_t index) {
  const RandomStream random(7, 0);
  return {random.uniform(3 * index, -50, 50), random.uniform(3 * index + 1, -50, 50),
          random.uniform(3 * index + 2, -10, 10)};
}

TEST(Transform2, ComposesByHand) {
  // Half a turn to the left at (1, 2), then one metre forward: one metre west of (1, 2).
  const Pose2 pose = Pose2{1.0, 2.0, kPi} * Motion2{1.0, 0.0, 0.25};
  expect_same(pose, {0.0, 2.0, -kPi + 0.25});
}

TEST(Transform2, InverseUndoes) {
  for (std::uint64_t i = 0; i < 100; ++i) {
    const Pose2 pose = random_pose(i);
    expect_same(pose.inverse() * pose, Motion2{});
    const Point2<frames::Robot> point{3.0, -4.0};
    const Point2<frames::Robot> back = pose.inverse() * (pose * point);
    EXPECT_NEAR(back.x, point.x, 1e-9);
    EXPECT_NEAR(back.y, point.y, 1e-9);
  }
}

TEST(Transform2, MapFromOdomCancelsTheOdometry) {
  const Pose2 map_from_robot = random_pose(1);
  const OdomPose2 odom_from_robot{5.0, 6.0, 0.7};
  const Transform2<frames::Map, frames::Odom> map_from_odom =
      map_from_robot * odom_from_robot.inverse();
  expect_same(map_from_odom * odom_from_robot, map_from_robot);
}

TEST(WrapAngle, StaysInTheHalfOpenTurn) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(3.0 * kPi + 0.1), -kPi + 0.1, 1e-12);
  EXPECT_NEAR(wrap_angle(-0.25), -0.25, 0.0);
}

}  // namespace
}  // namespace nadir
