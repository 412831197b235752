// SPDX-License-Identifier: Apache-2.0
// Stereo images rendered with exact poses, through matching to the local map.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/ground_mapping/depth/horizon.hpp"
#include "nadir/ground_mapping/mapper.hpp"
#include "nadir/ground_mapping/stereo_order.hpp"
#include "support/expect_error.hpp"

namespace nadir::test {
namespace {

StereoRig small_rig() { return make_rig(1.2, radians(15.0), 400, 192, 380.0, 0.4); }

Scene grainy_street() {
  Scene scene;
  scene.grain = 60.0;
  scene.kerb_y = 2.0;
  scene.kerb_height = 0.12;
  scene.boxes.push_back({9.0, 10.0, -4.0, -3.0, 0.8});
  return scene;
}

struct Mapped {
  GroundMapper mapper;
  FrameStatistics last;
};

Mapped drive(const Scene& scene, const StereoRig& rig, const GroundMappingOptions& options,
             int frames) {
  Mapped run{GroundMapper(rig, options), {}};
  for (int i = 0; i < frames; ++i) {
    const OdomPose3 pose = pose_at(0.5 * i, 0.0, 0.0);
    run.last = run.mapper.integrate(photograph(scene, rig, pose, at_step(i)), pose);
  }
  return run;
}

TEST(Stereo, MapsWhatItSees) {
  const Scene scene = grainy_street();
  const Mapped run = drive(scene, small_rig(), {}, 8);
  const LocalMap map = run.mapper.render({.size_x_m = 10.0, .size_y_m = 8.0});
  const Agreement a = agreement(truth_under(scene, map), map);
  EXPECT_LT(a.height_rmse_m, 0.01);
  EXPECT_GT(a.zncc, 0.97);
  EXPECT_LT(std::abs(a.shift_columns), 0.1);
  EXPECT_LT(std::abs(a.shift_rows), 0.1);
  EXPECT_GT(a.compared, 0.3);
  ASSERT_TRUE(map.ground_in_odom_m.has_value());
  EXPECT_NEAR(*map.ground_in_odom_m, 0.0, 0.02);
}

TEST(Stereo, OneAndSeveralThreadsGiveTheSameBytes) {
  const Scene scene = grainy_street();
  LocalMap first;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const LocalMap map = drive(scene, small_rig(), {}, 4).mapper.render({.ground_only = false});
    if (threads == 1) {
      first = map;
      EXPECT_GT(map.coverage, 0.05);
      continue;
    }
    EXPECT_EQ(map.ortho.image, first.ortho.image) << threads;
    EXPECT_EQ(map.ortho.valid, first.ortho.valid) << threads;
    EXPECT_EQ(map.weight, first.weight) << threads;
    EXPECT_TRUE(std::equal(map.elevation.height_m.values().begin(),
                           map.elevation.height_m.values().end(),
                           first.elevation.height_m.values().begin(),
                           [](float a, float b) { return a == b || (a != a && b != b); }));
  }
}

TEST(Stereo, HalfSizeSeesAsFar) {
  GroundMappingOptions half;
  half.image_scale = 0.5;
  const GroundMapper whole(small_rig(), {});
  const GroundMapper scaled(small_rig(), half);
  EXPECT_NEAR(scaled.max_range_m(), whole.max_range_m(), 1e-9);
  // Equation 4: sqrt(0.8 m * 152 px m / 0.5 px).
  EXPECT_NEAR(whole.max_range_m(), 15.5949, 1e-4);
  const Scene scene = grainy_street();
  const LocalMap map = drive(scene, small_rig(), half, 8).mapper.render({.size_x_m = 8.0});
  EXPECT_LT(agreement(truth_under(scene, map), map, 4.0).height_rmse_m, 0.03);
}

TEST(Stereo, RectifiesWhatIsNotRectified) {
  StereoRig rig = small_rig();
  rig.rectified = false;
  rig.left.k1 = -0.12;
  rig.left.k2 = 0.03;
  rig.right.k1 = -0.1;
  rig.right.p1 = 0.001;
  rig.right_from_left.rotation =
      Eigen::Quaterniond(Eigen::AngleAxisd(0.02, Eigen::Vector3d(0.3, 1.0, 0.5).normalized()));
  const Scene scene = grainy_street();
  const LocalMap map = drive(scene, rig, {}, 10).mapper.render({.size_x_m = 8.0, .size_y_m = 6.0});
  const Agreement a = agreement(truth_under(scene, map), map);
  EXPECT_LT(a.height_rmse_m, 0.01);
  EXPECT_GT(a.zncc, 0.97);
  EXPECT_LT(std::abs(a.shift_columns), 0.1);
}

TEST(Stereo, KnowsWhereTheHorizonIs) {
  const StereoRig rig = make_rig(1.0, radians(10.0), 640, 480, 400.0, 0.1);
  const auto turn = rig.robot_from_left.rotation.toRotationMatrix();
  // c_y - f tan(pitch) = 239.5 - 70.5 = 169, less a twentieth of 480, in steps of 16.
  EXPECT_EQ(ground::first_ground_row(rig.left, turn), 144);
  const auto up = make_rig(1.0, radians(-60.0), 640, 480, 400.0, 0.1);
  EXPECT_EQ(ground::first_ground_row(up.left, up.robot_from_left.rotation.toRotationMatrix()), 480);
  const auto down = make_rig(1.0, radians(89.0), 640, 480, 400.0, 0.1);
  EXPECT_EQ(ground::first_ground_row(down.left, down.robot_from_left.rotation.toRotationMatrix()),
            0);
}

TEST(Stereo, SkipsAFrameWithoutGround) {
  const StereoRig rig = make_rig(1.2, radians(-60.0), 400, 192, 380.0, 0.4);
  GroundMapper mapper(rig, {});
  const StereoFrame frame{Stamp{0}, Raster<std::uint8_t>(400, 192, 100),
                          Raster<std::uint8_t>(400, 192, 100)};
  EXPECT_EQ(mapper.integrate(frame, {}).status, MappingStatus::kNoGround);
}

TEST(Stereo, APlainImageGivesNoPoints) {
  GroundMappingOptions options;
  options.check_stereo_order = false;
  GroundMapper mapper(small_rig(), options);
  const StereoFrame frame{Stamp{0}, Raster<std::uint8_t>(400, 192, 100),
                          Raster<std::uint8_t>(400, 192, 100)};
  const FrameStatistics s = mapper.integrate(frame, {});
  EXPECT_EQ(s.status, MappingStatus::kNoPoints);
  EXPECT_EQ(s.dropped.total(), s.points_in);
  EXPECT_EQ(mapper.render({}).coverage, 0.0);
  EXPECT_FALSE(s.warnings.empty());
}

TEST(Stereo, RefusesSwappedImages) {
  const Scene scene = grainy_street();
  const StereoRig rig = small_rig();
  StereoFrame frame = photograph(scene, rig, {}, Stamp{0});
  const StereoOrder right = stereo_order(rig, frame, {});
  EXPECT_FALSE(right.looks_swapped()) << right.as_given << " " << right.swapped;
  std::swap(frame.left, frame.right);
  const StereoOrder wrong = stereo_order(rig, frame, {});
  EXPECT_TRUE(wrong.looks_swapped()) << wrong.as_given << " " << wrong.swapped;
  GroundMapper mapper(rig, {});
  expect_error(ErrorKind::kInput, {"left and right are swapped", "% of the pixels", "exchange"},
               [&] { mapper.integrate(frame, {}); });
}

}  // namespace
}  // namespace nadir::test
