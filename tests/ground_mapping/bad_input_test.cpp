// SPDX-License-Identifier: Apache-2.0
// One line with what is wrong and what to do, for every input that the stage cannot take.

#include <gtest/gtest.h>

#include <limits>

#include "ground_mapping/scene.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/ground_mapping/mapper.hpp"
#include "support/expect_error.hpp"

namespace nadir::test {
namespace {

void expect_rig_error(const StereoRig& bad, std::initializer_list<std::string> parts) {
  expect_error(ErrorKind::kInput, parts, [&] { const GroundMapper mapper(bad, {}); });
}

TEST(BadInput, RigsThatCannotBe) {
  StereoRig bad = small_rig();
  bad.right_from_left.translation.setZero();
  expect_rig_error(bad, {"baseline is 0", "calibration of the pair"});
  bad = small_rig();
  bad.right_from_left.translation.x() = 0.3;
  expect_rig_error(bad, {"baseline is negative", "swap left and right"});
  bad = small_rig();
  bad.right_from_left.translation.x() = -540.0;
  expect_rig_error(bad, {"baseline is 540 m", "millimetres"});
  bad = small_rig();
  bad.right_from_left.translation = {0.0, -0.3, 0.0};
  expect_rig_error(bad, {"one above or behind the other"});
  bad = small_rig();
  bad.left.fx = 0.0;
  expect_rig_error(bad, {"left camera", "focal lengths 0", "above 0"});
  bad = small_rig();
  bad.right.width = 300;
  expect_rig_error(bad, {"320 x 160", "300 x 160", "one size"});
  bad = small_rig();
  bad.robot_from_left.translation.x() = std::numeric_limits<double>::quiet_NaN();
  expect_rig_error(bad, {"not finite", "calibration"});
}

TEST(BadInput, OptionsThatContradict) {
  const auto refused = [](auto change, std::initializer_list<std::string> parts) {
    GroundMappingOptions options;
    change(options);
    expect_error(ErrorKind::kUsage, parts,
                 [&] { const GroundMapper mapper(small_rig(), options); });
  };
  refused([](auto& o) { o.grid_cells = 300; }, {"grid_cells = 300", "power of two"});
  refused([](auto& o) { o.block_size = 4; }, {"block_size = 4", "odd"});
  refused([](auto& o) { o.min_range_m = 9.0, o.max_range_m = 5.0; }, {"max_range_m = 5"});
  refused([](auto& o) { o.disparities = 288; },
          {"288 disparities", "at most 272", "reach down to"});
  refused([](auto& o) { o.max_range_m = 1.5; }, {"measures from", "raise ground_mapping"});
  refused([](auto& o) { o.lidar_max_range_m = 0.5; }, {"lidar_max_range_m = 0.5"});
}

TEST(BadInput, FramesThatCannotBe) {
  GroundMapper mapper(small_rig(), {});
  const StereoFrame good = photograph({}, small_rig(), {}, Stamp{5});
  StereoFrame bad = good;
  bad.right = Raster<std::uint8_t>(319, 160);
  expect_error(ErrorKind::kInput, {"right image has 319 x 160", "calibration says 320 x 160"},
               [&] { mapper.integrate(bad, {}); });
  bad = good;
  bad.stamp = Stamp{6};
  bad.left = Raster<std::uint8_t>(320, 160, 0, 4);
  expect_error(ErrorKind::kInput, {"left image has 4 channels", "RGB"},
               [&] { mapper.integrate(bad, {}); });
  OdomPose3 pose;
  pose.translation.x() = std::numeric_limits<double>::infinity();
  bad = good;
  bad.stamp = Stamp{7};
  expect_error(ErrorKind::kInput, {"odometry is not finite"}, [&] { mapper.integrate(bad, pose); });
  expect_error(ErrorKind::kUsage, {"not of the sensor"},
               [&] { mapper.integrate(sweep_at(Stamp{8}), {}); });
  mapper.integrate(StereoFrame{Stamp{9}, good.left, good.right}, {});
  expect_error(ErrorKind::kInput, {"stamp does not increase", "order of their stamps"}, [&] {
    mapper.integrate(StereoFrame{Stamp{9}, good.left, good.right}, {});
  });
}

TEST(BadInput, DepthInMillimetres) {
  const LidarRig lidar = make_lidar_rig();
  GroundMapper mapper(lidar, {});
  LidarFrame frame = sweep_at(Stamp{0});
  frame.points.assign(1000, LidarPoint{3000.0F, 100.0F, -1200.0F});
  expect_error(ErrorKind::kInput, {"median lidar range is 3233 m", "millimetres"},
               [&] { mapper.integrate(frame, {}); });
  StereoRig far = small_rig();
  far.right_from_left.translation.x() = -15.0;  // a pair in decimetres or worse
  GroundMappingOptions options;
  options.check_stereo_order = false;
  options.max_range_m = 1e3;  // allowed to a caller; the option's range holds for files
  GroundMapper stereo(far, options);
  const StereoFrame images = photograph({}, small_rig(), {}, Stamp{0});
  expect_error(ErrorKind::kInput, {"median stereo depth", "metres"},
               [&] { stereo.integrate(images, {}); });
}

TEST(BadInput, MoreOrFewerImagesThanCameras) {
  GroundMapper mapper(make_lidar_rig(), {});
  LidarFrame frame = sweep_at(Stamp{0});
  frame.images.resize(2);
  expect_error(ErrorKind::kInput, {"2 images", "1 cameras"}, [&] { mapper.integrate(frame, {}); });
}

TEST(BadInput, LocalMapsThatTheGridCannotHold) {
  GroundMappingOptions options;
  options.grid_cells = 128;
  GroundMapper mapper(small_rig(), options);
  expect_error(ErrorKind::kUsage, {"before the first frame"}, [&] { (void)mapper.render({}); });
  mapper.integrate(photograph({}, small_rig(), {}, Stamp{0}), {});
  expect_error(ErrorKind::kUsage, {"18 x 18 m", "grid of 12.8 m", "grid_cells"},
               [&] { (void)mapper.render({}); });
}

}  // namespace
}  // namespace nadir::test
