// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/self_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "support/expect_error.hpp"

namespace nadir::test {
namespace {

Scene kerbed_street() {
  Scene scene;
  scene.kerb_y = 2.0;
  scene.kerb_height = 0.12;
  return scene;
}

MapComparison odd_even(double yaw_error_per_frame, double scale) {
  const StereoRig rig = make_rig(1.2, radians(15.0), 320, 160, 300.0, 0.3);
  OddEvenCheck check(rig, {});
  for (int i = 0; i < 16; ++i) {
    const OdomPose3 pose = pose_at(0.4 * i, 0.0, 0.0);
    const OdomPose3 claimed = pose_at(scale * 0.4 * i, 0.0, yaw_error_per_frame * i);
    check.integrate(photograph(kerbed_street(), rig, pose, at_step(i)), claimed);
  }
  return check.compare({.size_x_m = 8.0, .size_y_m = 6.0});
}

TEST(SelfCheck, OddAndEvenFramesAgreeWhereThePosesAreRight) {
  const MapComparison c = odd_even(0.0, 1.0);
  EXPECT_EQ(c.shift_columns, 0);
  EXPECT_EQ(c.shift_rows, 0);
  EXPECT_GT(c.zncc, 0.9);
  EXPECT_LT(c.height_median_m, 0.015);
  EXPECT_GT(c.overlap, 0.4);
  EXPECT_FALSE(pose_misfit(c).has_value());
}

TEST(SelfCheck, WrongPosesAreNamed) {
  // Poses of another drive: steps twice as long.
  const MapComparison c = odd_even(0.0, 2.0);
  const auto said = pose_misfit(c);
  ASSERT_TRUE(said.has_value()) << c.zncc << " " << c.shift_columns << " " << c.height_p90_m;
  EXPECT_NE(said->find("the poses do not fit the images"), std::string::npos);
  EXPECT_LT(c.zncc_unshifted, 0.8);
}

TEST(SelfCheck, FindsAKnownShift) {
  const Scene scene = kerbed_street();
  const LidarRig rig = make_lidar_rig();
  GroundMapper mapper(rig, {});
  LidarFrame frame = sweep_at(Stamp{0});
  for (double x = -6.0; x < 6.0; x += 0.05) {
    for (double y = -6.0; y < 6.0; y += 0.05) {
      frame.points.push_back({static_cast<float>(x), static_cast<float>(y),
                              static_cast<float>(scene.ground(x, y) - 1.2)});
    }
  }
  for (const MountedCamera& camera : rig.cameras) {
    frame.images.push_back(photograph(scene, camera.model, OdomPose3{} * camera.robot_from_camera));
  }
  mapper.integrate(frame, {});
  const LocalMap a = mapper.render({.size_x_m = 9.0, .size_y_m = 6.0, .at = pose_at(0, 0, 0)});
  const LocalMap b = mapper.render({.size_x_m = 9.0, .size_y_m = 6.0, .at = pose_at(0.3, -0.2, 0)});
  const MapComparison c = compare_local_maps(a, b);
  // What is ahead comes nearer; what lies to the right of the robot's way moves up.
  EXPECT_EQ(c.shift_columns, -3);
  EXPECT_EQ(c.shift_rows, -2);
  EXPECT_GT(c.zncc, 0.99);
}

TEST(SelfCheck, RefusesMapsOfTwoSizesAndAnEmptyCheck) {
  const LidarRig rig = make_lidar_rig();
  GroundMapper mapper(rig, {});
  mapper.integrate(sweep_at(Stamp{0}), {});
  const LocalMap small = mapper.render({.size_x_m = 6.0});
  expect_error(ErrorKind::kUsage, {"differ in size"},
               [&] { (void)compare_local_maps(small, mapper.render({})); });
  EXPECT_TRUE(std::isnan(compare_local_maps(small, small).zncc));
  const OddEvenCheck check(rig, {});
  expect_error(ErrorKind::kUsage, {"at least one of each"}, [&] { (void)check.compare({}); });
}

}  // namespace
}  // namespace nadir::test
