// SPDX-License-Identifier: Apache-2.0
// What a writer of drives wrote is read back; every layout gives the rig, frames and poses that its
// files say.

#include <gtest/gtest.h>

#include "io/small_drive.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/point_cloud.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/trajectories/pose_file.hpp"
#include "support/data.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using test::write_text;

template <class To, class From>
void expect_near(const Transform3<To, From>& a, const Transform3<To, From>& b, double allowed) {
  EXPECT_LT((a.translation - b.translation).norm(), allowed);
  EXPECT_LT(a.rotation.angularDistance(b.rotation), allowed);
}

TEST(Drive, ReadsBackStereoThatWasWritten) {
  for (const int channels : {1, 3}) {
    const TemporaryFolder folder;
    test::write_small_stereo(folder.path(), 4, channels);
    const Drive drive = open_drive(folder.path());
    EXPECT_EQ(drive.format, DriveFormat::kKittiStereo);
    ASSERT_TRUE(drive.is_stereo());
    const auto& rig = std::get<StereoRig>(drive.rig);
    const StereoRig written = test::small_stereo_rig();
    EXPECT_EQ(rig.left, written.left);
    EXPECT_EQ(rig.right, written.right);
    EXPECT_TRUE(rig.rectified);
    EXPECT_NEAR(rig.baseline_m(), 0.4, 1e-12);
    expect_near(rig.right_from_left, written.right_from_left, 1e-12);
    expect_near(rig.robot_from_left, written.robot_from_left, 1e-12);
    ASSERT_EQ(drive.frames.size(), 4U);
    ASSERT_TRUE(drive.odometry);
    ASSERT_EQ(drive.odometry->size(), 4U);
    for (int i = 0; i < 4; ++i) {
      const DriveFrame& frame = drive.frames[static_cast<std::size_t>(i)];
      EXPECT_EQ(frame.number, i);
      EXPECT_EQ(frame.stamp, test::small_stamp(i));
      const StereoFrame stereo = drive.read_stereo(frame);
      EXPECT_EQ(stereo.left, test::small_stereo_frame(i, channels).left);
      EXPECT_EQ(stereo.right, test::small_stereo_frame(i, channels).right);
      const auto pose = pose_at(*drive.odometry, frame.stamp);
      ASSERT_TRUE(pose);
      expect_near(*pose, test::small_pose(i), 1e-8);
    }
    EXPECT_TRUE(drive.notes.empty()) << drive.notes.front();
  }
}

TEST(Drive, CameraPosesAreTheRobotsSeenFromItsFirstPose) {
  const TemporaryFolder folder;
  test::write_small_stereo(folder.path());
  DriveReadOptions options;
  options.poses = folder / "poses.txt";
  const Drive drive = open_drive(folder.path(), options);
  const OdomPose3 first = test::small_pose(0);
  for (int i = 0; i < 4; ++i) {
    const auto motion = first.inverse() * test::small_pose(i);
    const OdomPose3& read = (*drive.odometry)[static_cast<std::size_t>(i)].odom_from_robot;
    expect_near(read, {motion.rotation, motion.translation}, 1e-8);
  }
}

TEST(Drive, ReadsBackLidarThatWasWritten) {
  const TemporaryFolder folder;
  test::write_small_lidar(folder.path());
  const Drive drive = open_drive(folder.path());
  EXPECT_EQ(drive.format, DriveFormat::kKittiLidar);
  ASSERT_FALSE(drive.is_stereo());
  const auto& rig = std::get<LidarRig>(drive.rig);
  const LidarRig written = test::small_lidar_rig();
  expect_near(rig.robot_from_lidar, written.robot_from_lidar, 1e-9);
  ASSERT_EQ(rig.cameras.size(), 1U);
  EXPECT_EQ(rig.cameras[0].model, written.cameras[0].model);
  expect_near(rig.cameras[0].robot_from_camera, written.cameras[0].robot_from_camera, 1e-9);
  std::vector<std::string> notes;
  const LidarFrame frame = drive.read_lidar(drive.frames[2], notes);
  const LidarFrame expected = test::small_lidar_frame(2);
  ASSERT_EQ(frame.points.size(), expected.points.size());
  for (std::size_t i = 0; i < frame.points.size(); ++i) {
    EXPECT_EQ(frame.points[i].x, expected.points[i].x);
    EXPECT_EQ(frame.points[i].intensity, expected.points[i].intensity);
  }
  EXPECT_EQ(frame.images.at(0), expected.images.at(0));
  EXPECT_TRUE(notes.empty());
}

TEST(Drive, LidarWithoutMountingIsTheRobot) {
  const TemporaryFolder folder;
  test::write_small_lidar(folder.path());
  fs::remove(folder / "mounting.yaml");
  const Drive drive = open_drive(folder.path());
  const auto& rig = std::get<LidarRig>(drive.rig);
  const LidarRig written = test::small_lidar_rig();
  expect_near(rig.robot_from_lidar, {}, 1e-12);
  const auto mounted = written.robot_from_lidar.inverse() * written.cameras[0].robot_from_camera;
  expect_near(rig.cameras[0].robot_from_camera, {mounted.rotation, mounted.translation}, 1e-9);
}

TEST(Drive, StereoWithoutMountingHasTheRobotLevelAtTheCamera) {
  const TemporaryFolder folder;
  test::write_small_stereo(folder.path());
  fs::remove(folder / "mounting.yaml");
  const auto rig = std::get<StereoRig>(open_drive(folder.path()).rig);
  expect_near(rig.robot_from_left, {forward_camera_rotation(), Eigen::Vector3d::Zero()}, 1e-12);
}

TEST(Drive, CameraHeightAndPitchAreAMountingToo) {
  const TemporaryFolder folder;
  test::write_small_stereo(folder.path());
  write_text(folder / "mounting.yaml", "camera_height_m: 1.2\ncamera_pitch_deg: 90\n");
  const auto rig = std::get<StereoRig>(open_drive(folder.path()).rig);
  EXPECT_NEAR(rig.robot_from_left.translation.z(), 1.2, 1e-12);
  // It looks straight down: its z axis is the robot's -z, its y axis (down in the image) points
  // backwards.
  const Eigen::Matrix3d r = rig.robot_from_left.rotation.toRotationMatrix();
  EXPECT_LT((r.col(2) - Eigen::Vector3d(0, 0, -1)).norm(), 1e-12);
  EXPECT_LT((r.col(1) - Eigen::Vector3d(-1, 0, 0)).norm(), 1e-12);
}

TEST(Drive, TakesTheFramesAskedFor) {
  const TemporaryFolder folder;
  test::write_small_stereo(folder.path(), 6);
  DriveReadOptions options;
  options.first = 2;
  options.count = 3;
  const Drive drive = open_drive(folder.path(), options);
  ASSERT_EQ(drive.frames.size(), 3U);
  EXPECT_EQ(drive.frames[0].number, 2);
  EXPECT_EQ(drive.frames[2].stamp, test::small_stamp(4));
}

TEST(Drive, KittiRowsMayBelongToTheFramesAskedFor) {
  const TemporaryFolder folder;
  test::write_small_stereo(folder.path(), 6);
  const std::string rows = test::read_text(folder / "poses.txt");
  std::size_t third = 0;
  for (int i = 0; i < 3; ++i) third = rows.find('\n', third) + 1;
  write_text(folder / "part.txt", rows.substr(0, third));
  DriveReadOptions options;
  options.poses = folder / "part.txt";
  options.first = 1;
  options.count = 3;
  const Drive drive = open_drive(folder.path(), options);
  EXPECT_EQ(drive.odometry->front().stamp, test::small_stamp(1));
}

TEST(Drive, ReadsKeylessCalibrationWithoutFinalNewlineAndTimes) {
  const TemporaryFolder folder;
  for (int i = 0; i < 3; ++i) {
    for (const char* side : {"image_l", "image_r"}) {
      fs::create_directories(folder / side);
      write_png(folder / side / ("00000" + std::to_string(i) + ".png"), test::noise_image(1, 1));
    }
  }
  write_text(folder / "calib.txt",
             "20 0 11.5 0 0 20 4.5 0 0 0 1 0\n20 0 11.5 -8 0 20 4.5 0 0 0 1 0");
  const Drive drive = open_drive(folder.path());
  const auto& rig = std::get<StereoRig>(drive.rig);
  EXPECT_EQ(rig.left, test::small_camera());
  EXPECT_NEAR(rig.baseline_m(), 0.4, 1e-12);
  EXPECT_EQ(drive.frames[2].stamp.nanoseconds, 200'000'000);
  EXPECT_FALSE(drive.odometry);
  EXPECT_EQ(drive.notes.size(), 1U) << "the assumed 10 Hz must be said";
}

TEST(Drive, PosesAreInterpolatedInSpace) {
  const OdomPose3 a = test::small_pose(0);
  const OdomPose3 b = test::small_pose(2);
  const std::vector<StampedOdomPose3> poses{{{0}, a}, {{400'000'000}, b}};
  const auto middle = pose_at(poses, {100'000'000});
  ASSERT_TRUE(middle);
  EXPECT_LT((middle->translation - (0.75 * a.translation + 0.25 * b.translation)).norm(), 1e-12);
  EXPECT_NEAR(middle->rotation.angularDistance(a.rotation),
              0.25 * b.rotation.angularDistance(a.rotation), 1e-9);
  EXPECT_TRUE(pose_at(poses, {409'000'000}));
  EXPECT_FALSE(pose_at(poses, {411'000'000}));
  EXPECT_FALSE(pose_at({{{0}, a}, {{600'000'000}, b}}, {300'000'000})) << "too wide a gap";
}

TEST(Drive, ReadsTheRealDrives) {
  const auto stereo = test::find_data("kitti_stereo");
  const auto lidar = test::find_data("kitti_lidar");
  if (!stereo || !lidar) GTEST_SKIP() << test::kNoData;
  for (const char* name : {"odometry_01", "straight_street"}) {
    const Drive drive = open_drive(*stereo / name);
    EXPECT_EQ(drive.frames.size(), 51U);
    ASSERT_EQ(drive.odometry->size(), 51U);
    const StereoFrame frame = drive.read_stereo(drive.frames.back());
    EXPECT_EQ(frame.left.width(), std::get<StereoRig>(drive.rig).left.width);
    const OdomPose3& last = drive.odometry->back().odom_from_robot;
    EXPECT_GT(last.translation.head<2>().norm(), 40.0) << "the car drives on the ground";
    EXPECT_LT(std::abs(last.translation.z()), 3.0);
  }
  const Drive drive = open_drive(*lidar);
  EXPECT_EQ(drive.frames.size(), 15U);
  std::vector<std::string> notes;
  const LidarFrame frame = drive.read_lidar(drive.frames.front(), notes);
  EXPECT_GT(frame.points.size(), 100'000U);
  const auto& camera = std::get<LidarRig>(drive.rig).cameras.at(0);
  // The camera stands 0.27 m ahead of the lidar and 8 cm below it, and looks forward.
  EXPECT_NEAR(camera.robot_from_camera.translation.x(), 0.27, 0.02);
  EXPECT_NEAR(camera.robot_from_camera.translation.z(), -0.08, 0.02);
  EXPECT_GT((camera.robot_from_camera.rotation * Eigen::Vector3d::UnitZ()).x(), 0.99);
}

}  // namespace
}  // namespace nadir
