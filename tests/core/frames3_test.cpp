// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/frames3.hpp"

#include <gtest/gtest.h>

#include "nadir/core/random.hpp"

namespace nadir {
namespace {

using RobotInOdom = Transform3<frames::Odom, frames::Robot>;

RobotInOdom random_spatial_pose(std::uint64_t seed) {
  const RandomStream random(seed, 0);
  const Eigen::Vector3d axis{random.normal(0), random.normal(1), random.normal(2)};
  return {Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(3, -3.0, 3.0), axis.normalized())),
          {random.uniform(4, -9, 9), random.uniform(5, -9, 9), random.uniform(6, -9, 9)}};
}

TEST(Transform3, ComposesAndInvertsLikeItsMatrices) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RobotInOdom pose = random_spatial_pose(seed);
    const Transform3<frames::Robot, frames::Camera> mount{random_spatial_pose(seed + 100).rotation,
                                                          {0.3, -0.2, 1.1}};
    const Point3<frames::Camera> point{1.0, -2.0, 5.0};
    const Eigen::Vector3d expected =
        pose.rotation * (mount.rotation * point.vector() + mount.translation) + pose.translation;
    EXPECT_LT((((pose * mount) * point).vector() - expected).norm(), 1e-12);
    const auto back = (pose * mount).inverse() * Point3<frames::Odom>::from(expected);
    EXPECT_LT((back.vector() - point.vector()).norm(), 1e-12);
  }
}

TEST(Transform3, PlanarAndSpatialAreInverseOnLevelPoses) {
  const OdomPose2 flat{3.0, -4.0, 2.5};
  const OdomPose2 again = planar(spatial(flat, 1.5));
  EXPECT_NEAR(again.x, flat.x, 1e-12);
  EXPECT_NEAR(again.y, flat.y, 1e-12);
  EXPECT_NEAR(again.yaw, flat.yaw, 1e-12);
}

TEST(Transform3, ForwardCameraLooksAlongTheRobotsXAxis) {
  const Eigen::Quaterniond rotation = forward_camera_rotation();
  EXPECT_LT((rotation * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((rotation * Eigen::Vector3d::UnitX() + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_LT((rotation * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

}  // namespace
}  // namespace nadir
