// SPDX-License-Identifier: Apache-2.0
// Layouts that other programs write: KITTI raw, EuRoC, folders with OpenCV's or Kalibr's YAML.

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "io/small_drive.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/point_cloud.hpp"
#include "nadir/io/image.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::TemporaryFolder;
using test::write_text;

void write_images(const fs::path& folder, const std::vector<std::string>& names) {
  fs::create_directories(folder);
  for (const std::string& name : names) write_png(folder / name, test::noise_image(3, 1));
}

const char* const kRawCalibration =
    "calib_time: 09-Jan-2012 13:57:47\n"
    "corner_dist: 9.950000e-02\n"
    "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
    "P_rect_00: 20 0 11.5 0 0 20 4.5 0 0 0 1 0\n"
    "P_rect_01: 20 0 11.5 -8 0 20 4.5 0 0 0 1 0\n"
    "P_rect_02: 20 0 11.5 1.2 0 20 4.5 0 0 0 1 0\n"
    "P_rect_03: 20 0 11.5 -6.8 0 20 4.5 0 0 0 1 0\n";

const char* const kRawTimes =
    "2011-09-26 13:02:25.964389445\n"
    "2011-09-26 13:02:26.067883968\n";

TEST(DriveLayouts, KittiRawStereoAndLidar) {
  const TemporaryFolder folder;
  const fs::path drive_folder = folder / "2011_09_26_drive_0001_sync";
  const std::vector<std::string> names{"0000000000.png", "0000000001.png"};
  for (const char* camera : {"image_02", "image_03"}) {
    write_images(drive_folder / camera / "data", names);
    write_text(drive_folder / camera / "timestamps.txt", kRawTimes);
  }
  fs::create_directories(drive_folder / "velodyne_points" / "data");
  for (const char* name : {"0000000000.bin", "0000000001.bin"}) {
    write_velodyne(drive_folder / "velodyne_points" / "data" / name, {{5, 0, -1, 0.5F, 0}});
  }
  write_text(drive_folder / "velodyne_points" / "timestamps.txt", kRawTimes);
  write_text(folder / "calib_cam_to_cam.txt", kRawCalibration);
  write_text(folder / "calib_velo_to_cam.txt",
             "calib_time: 15-Mar-2012 11:37:16\nR: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.08 -0.27\n");

  const Drive stereo = open_drive(drive_folder);
  EXPECT_EQ(stereo.format, DriveFormat::kKittiRaw);
  ASSERT_TRUE(stereo.is_stereo());
  const auto& rig = std::get<StereoRig>(stereo.rig);
  EXPECT_NEAR(rig.baseline_m(), 0.4, 1e-12);
  EXPECT_TRUE(rig.rectified);
  // 1.2 / 20 m left of camera 0, where the robot is.
  EXPECT_NEAR(rig.robot_from_left.translation.y(), 0.06, 1e-12);
  EXPECT_EQ(to_string(stereo.frames[0].stamp), "1317042145.964389445");
  EXPECT_EQ(to_string(stereo.frames[1].stamp), "1317042146.067883968");

  DriveReadOptions options;
  options.sensor = DriveSensor::kLidar;
  const Drive lidar = open_drive(drive_folder, options);
  ASSERT_FALSE(lidar.is_stereo());
  const auto& camera = std::get<LidarRig>(lidar.rig).cameras.at(0);
  EXPECT_NEAR(camera.robot_from_camera.translation.x(), 0.27, 1e-12);
  EXPECT_NEAR(camera.robot_from_camera.translation.y(), 0.06, 1e-12);
  EXPECT_NEAR(camera.robot_from_camera.translation.z(), -0.08, 1e-12);
  std::vector<std::string> notes;
  EXPECT_EQ(lidar.read_lidar(lidar.frames[1], notes).points.size(), 1U);
}

std::string sensor_yaml(double x_m) {
  return "# General sensor definitions.\nsensor_type: camera\ncomment: VI-Sensor\n"
         "T_BS:\n  cols: 4\n  rows: 4\n  data: [0.0, 0.0, 1.0, 0.5,\n         -1.0, 0.0, 0.0, " +
         std::to_string(x_m) +
         ",\n         0.0, -1.0, 0.0, 0.0,\n         0.0, 0.0, 0.0, 1.0]\n"
         "rate_hz: 20\nresolution: [24, 10]\ncamera_model: pinhole\n"
         "intrinsics: [20.0, 21.0, 11.5, 4.5] #fu, fv, cu, cv\n"
         "distortion_model: radial-tangential\n"
         "distortion_coefficients: [-0.28, 0.07, 0.0002, 1.8e-05]\n";
}

TEST(DriveLayouts, Euroc) {
  const TemporaryFolder folder;
  const fs::path mav = folder / "mav0";
  for (const auto& [camera, y] : {std::pair{"cam0", 0.05}, std::pair{"cam1", -0.06}}) {
    write_images(mav / camera / "data", {"1403636579763555584.png", "1403636579813555456.png"});
    write_text(mav / camera / "sensor.yaml", sensor_yaml(y));
    write_text(mav / camera / "data.csv",
               "#timestamp [ns],filename\r\n1403636579763555584,1403636579763555584.png\r\n"
               "1403636579813555456,1403636579813555456.png\r\n");
  }
  write_text(mav / "state_groundtruth_estimate0" / "data.csv",
             "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x []\n"
             "1403636579763555584,4.0,-1.7,0.8,1,0,0,0,0,0,0\n"
             "1403636579813555456,5.0,-1.7,0.8,0.70710678,0,0,0.70710678,0,0,0\n");
  const Drive drive = open_drive(folder.path());
  EXPECT_EQ(drive.format, DriveFormat::kEuroc);
  const auto& rig = std::get<StereoRig>(drive.rig);
  EXPECT_FALSE(rig.rectified);
  EXPECT_NEAR(rig.baseline_m(), 0.11, 1e-12);
  EXPECT_NEAR(rig.right_from_left.translation.x(), -0.11, 1e-12);
  EXPECT_DOUBLE_EQ(rig.left.fy, 21.0);
  EXPECT_DOUBLE_EQ(rig.left.p1, 0.0002);
  EXPECT_EQ(drive.frames[1].stamp.nanoseconds, 1403636579813555456);
  ASSERT_TRUE(drive.odometry);
  // The robot is at the camera, 0.5 m ahead of the body and 5 cm to its left; the quaternion has w
  // first, so that the second pose is turned by 90 degrees about z.
  const OdomPose3& first = drive.odometry->at(0).odom_from_robot;
  EXPECT_LT((first.translation - Eigen::Vector3d(4.5, -1.65, 0.8)).norm(), 1e-9);
  EXPECT_NEAR(yaw_of(first), 0.0, 1e-9);
  const OdomPose3& second = drive.odometry->at(1).odom_from_robot;
  EXPECT_LT((second.translation - Eigen::Vector3d(4.95, -1.2, 0.8)).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(second), kPi / 2.0, 1e-6);
}

TEST(DriveLayouts, EurocOfAnotherLensIsRefused) {
  const TemporaryFolder folder;
  std::string yaml = sensor_yaml(0.0);
  yaml.replace(yaml.find("radial-tangential"), 17, "equidistant");
  write_text(folder / "mav0" / "cam0" / "sensor.yaml", yaml);
  expect_error(ErrorKind::kInput, {"sensor.yaml", "equidistant", "undistort"},
               [&] { open_drive(folder.path()); });
}

void write_plain_folder(const fs::path& folder) {
  write_images(folder / "left", {"left_01.png", "left_02.png"});
  write_images(folder / "right", {"right_01.png", "right_02.png"});
}

TEST(DriveLayouts, OpenCvCalibrationInTwoFiles) {
  const TemporaryFolder folder;
  write_plain_folder(folder.path());
  cv::FileStorage intrinsics((folder / "intrinsics.yml").string(), cv::FileStorage::WRITE);
  const cv::Mat k = (cv::Mat_<double>(3, 3) << 20, 0, 11.5, 0, 21, 4.5, 0, 0, 1);
  const cv::Mat d = (cv::Mat_<double>(1, 5) << -0.3, 0.1, 0.001, 0.002, 0.01);
  intrinsics << "M1" << k << "D1" << d << "M2" << k << "D2" << d;
  intrinsics.release();
  cv::FileStorage extrinsics((folder / "extrinsics.yml").string(), cv::FileStorage::WRITE);
  extrinsics << "R" << cv::Mat::eye(3, 3, CV_64F) << "T"
             << (cv::Mat_<double>(3, 1) << -0.12, 0.001, 0);
  extrinsics.release();
  const Drive drive = open_drive(folder.path());
  EXPECT_EQ(drive.format, DriveFormat::kStereoFolder);
  const auto& rig = std::get<StereoRig>(drive.rig);
  EXPECT_DOUBLE_EQ(rig.left.k3, 0.01);
  EXPECT_DOUBLE_EQ(rig.left.p2, 0.002);
  EXPECT_DOUBLE_EQ(rig.right.fy, 21.0);
  EXPECT_DOUBLE_EQ(rig.right_from_left.translation.x(), -0.12);
  EXPECT_FALSE(rig.rectified);
  EXPECT_EQ(rig.left.width, test::kSmallWidth);
  EXPECT_EQ(drive.frames.size(), 2U);
}

TEST(DriveLayouts, KalibrCamchain) {
  const TemporaryFolder folder;
  write_plain_folder(folder.path());
  const std::string camera =
      "  camera_model: pinhole\n  distortion_coeffs: [-0.2, 0.05, 0.001, 0.0]\n"
      "  distortion_model: radtan\n  intrinsics: [20.0, 21.0, 11.5, 4.5]\n"
      "  resolution: [24, 10]\n  rostopic: /cam/image_raw\n";
  write_text(folder / "camchain.yaml",
             "cam0:\n" + camera + "cam1:\n" + camera +
                 "  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.1]\n  - [0.0, 1.0, 0.0, 0.0]\n"
                 "  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n");
  const auto rig = std::get<StereoRig>(open_drive(folder.path()).rig);
  EXPECT_NEAR(rig.baseline_m(), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(rig.left.k1, -0.2);
  EXPECT_EQ(rig.right.height, 10);
}

}  // namespace
}  // namespace nadir
