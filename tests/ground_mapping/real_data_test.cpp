// SPDX-License-Identifier: Apache-2.0
// What the real stereo sequences must give, with the defaults that serve all data.

#include <gtest/gtest.h>

#include <string>

#include "nadir/ground_mapping/self_check.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "support/data.hpp"

namespace nadir::test {
namespace {

struct Expectation {
  const char* drive;
  double zncc;
  double height_median_m;
};

class RealStereo : public testing::TestWithParam<Expectation> {};

TEST_P(RealStereo, CoversTheGroundAndAgreesWithItself) {
  const auto folder = find_data(std::string("kitti_stereo/") + GetParam().drive);
  if (!folder) GTEST_SKIP() << kNoData;
  const Drive drive = open_drive(*folder);
  const auto& rig = std::get<StereoRig>(drive.rig);
  GroundMapper mapper(rig, {});
  OddEvenCheck check(rig, {});
  for (const DriveFrame& entry : drive.frames) {
    const StereoFrame frame = drive.read_stereo(entry);
    const auto pose = pose_at(drive.odometry.value(), frame.stamp);
    ASSERT_TRUE(pose.has_value());
    const FrameStatistics s = mapper.integrate(frame, *pose);
    EXPECT_EQ(s.status, MappingStatus::kOk);
    EXPECT_FALSE(s.map_dropped);
    EXPECT_LT(s.dropped.total(), s.points_in);
    check.integrate(frame, *pose);
  }
  EXPECT_GE(mapper.render({}).coverage, 0.96);
  EXPECT_GE(coverage_of(mapper.render({}), 9.0), 0.99);
  const MapComparison c = check.compare({});
  EXPECT_GE(c.zncc, GetParam().zncc);
  EXPECT_EQ(c.shift_columns, 0);
  EXPECT_EQ(c.shift_rows, 0);
  EXPECT_LE(c.height_median_m, GetParam().height_median_m);
  EXPECT_FALSE(pose_misfit(c).has_value());
}

INSTANTIATE_TEST_SUITE_P(Kitti, RealStereo,
                         testing::Values(Expectation{"straight_street", 0.90, 0.015},
                                         Expectation{"odometry_01", 0.86, 0.03}),
                         [](const auto& tested) { return std::string(tested.param.drive); });

TEST(RealPoses, OfAnotherDriveAreFound) {
  const auto folder = find_data("kitti_stereo/straight_street");
  const auto other = find_data("kitti_stereo/odometry_01");
  if (!folder || !other) GTEST_SKIP() << kNoData;
  const Drive drive = open_drive(*folder);
  const Drive wrong = open_drive(*other);
  OddEvenCheck check(std::get<StereoRig>(drive.rig), {});
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    check.integrate(drive.read_stereo(drive.frames[i]),
                    wrong.odometry.value().at(i).odom_from_robot);
  }
  const MapComparison c = check.compare({});
  EXPECT_TRUE(pose_misfit(c).has_value())
      << c.zncc << " " << c.shift_columns << " " << c.shift_rows << " " << c.height_p90_m;
}

}  // namespace
}  // namespace nadir::test
