// SPDX-License-Identifier: Apache-2.0
// Every bad input of a drive is named in one line with the file, the frame or line, the value and
// the cure.

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "io/small_drive.hpp"
#include "nadir/io/drives/detail/camera_yaml.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/trajectories/pose_file.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using test::TemporaryFolder;
using test::write_text;

const char* const kLfsPointer =
    "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n";

/// One good drive a test, to be spoiled.
class DriveBadInput : public ::testing::Test {
 protected:
  DriveBadInput() { test::write_small_stereo(place(), 5); }

  fs::path place() const { return folder_.path() / "drive"; }

  void expect_refused(std::initializer_list<std::string> parts,
                      const DriveReadOptions& options = {}) const {
    expect_error(ErrorKind::kInput, parts, [&] {
      const Drive drive = open_drive(place(), options);
      for (const DriveFrame& frame : drive.frames) drive.read_stereo(frame);
    });
  }

  void replace_line(const std::string& file, int line, const std::string& text) const {
    const std::string whole = test::read_text(place() / file);
    std::string::size_type begin = 0;
    for (int i = 1; i < line; ++i) begin = whole.find('\n', begin) + 1;
    write_text(place() / file,
               whole.substr(0, begin) + text + whole.substr(whole.find('\n', begin)));
  }

  TemporaryFolder folder_;
};

TEST_F(DriveBadInput, NoDrive) {
  expect_error(ErrorKind::kInput, {"no/such", "no such"}, [] { open_drive("no/such"); });
  fs::create_directories(folder_ / "empty");
  expect_error(ErrorKind::kInput, {"empty", "known layout", "KITTI", "EuRoC"},
               [&] { open_drive(folder_ / "empty"); });
}

TEST_F(DriveBadInput, MissingPartnerImage) {
  fs::remove(place() / "image_1" / "000003.png");
  expect_refused({"image_0/000003.png", "no partner", "5 files", "image_1", " 4"});
}

TEST_F(DriveBadInput, OddPartnerImage) {
  fs::copy(place() / "image_1" / "000003.png", place() / "image_1" / "000009.png");
  expect_refused({"image_1/000009.png", "no partner", "image_0"});
}

TEST_F(DriveBadInput, SizesDiffer) {
  write_png(place() / "image_1" / "000002.png", Raster<std::uint8_t>(20, 10, 9));
  expect_refused({"image_0/000002.png", "24 x 10", "image_1/000002.png", "20 x 10"});
  write_png(place() / "image_0" / "000002.png", Raster<std::uint8_t>(20, 10, 9));
  expect_refused({"image_0/000002.png", "20 x 10", "24 x 10", "calibration"});
}

TEST_F(DriveBadInput, ColourAgainstGrey) {
  write_png(place() / "image_1" / "000002.png", Raster<std::uint8_t>(24, 10, 9, 3));
  expect_refused({"image_0/000002.png", "1 channels", "image_1/000002.png", "3"});
}

TEST_F(DriveBadInput, SixteenBits) {
  cv::imwrite((place() / "image_0" / "000001.png").string(), cv::Mat(10, 24, CV_16U, 900.0));
  expect_refused({"image_0/000001.png", "8 bits"});
}

TEST_F(DriveBadInput, LfsPointers) {
  const std::string image = test::read_text(place() / "image_0" / "000001.png");
  write_text(place() / "image_0" / "000001.png", kLfsPointer);
  expect_refused({"image_0/000001.png", "git lfs pull"});
  write_text(place() / "image_0" / "000001.png", image);
  write_text(place() / "calib.txt", kLfsPointer);
  expect_refused({"calib.txt", "git lfs pull"});
}

TEST_F(DriveBadInput, Calibration) {
  const std::string p1 = "P1: 20 0 11.5 ";
  replace_line("calib.txt", 2, p1 + "0 0 20 4.5 0 0 0 1 0");
  expect_refused({"calib.txt:2", "'P1'", "no baseline"});
  replace_line("calib.txt", 2, p1 + "8 0 20 4.5 0 0 0 1 0");
  expect_refused({"calib.txt:2", "-0.4 m", "swap left and right"});
  replace_line("calib.txt", 2, "P1: -20 0 11.5 -8 0 20 4.5 0 0 0 1 0");
  expect_refused({"calib.txt:2", "focal length -20"});
  replace_line("calib.txt", 2, "P1: 20 0 11.5 -8 0 20 4.5 0 0 0 1");
  expect_refused({"calib.txt:2", "11 numbers instead of 12"});
  replace_line("calib.txt", 2, "P1: 20 0 11.5 -8 0 nan 4.5 0 0 0 1 0");
  expect_refused({"calib.txt:2", "nan"});
  write_text(place() / "calib.txt", "P0: 20 0 11.5 0 0 20 4.5 0 0 0 1 0\n");
  expect_refused({"calib.txt", "no projection of camera 1"});
}

TEST_F(DriveBadInput, PosesOfAnotherCount) {
  fs::remove(place() / "odometry.tum");
  std::string rows = test::read_text(place() / "poses.txt");
  rows.erase(rows.rfind('\n', rows.size() - 2) + 1);
  write_text(place() / "poses.txt", rows);
  expect_refused({"poses.txt", "4 poses for 5 frames", "--first", "--count"});
}

TEST_F(DriveBadInput, PosesThatAreNone) {
  fs::remove(place() / "odometry.tum");
  replace_line("poses.txt", 3, "2 0 0 0 0 1 0 0 0 0 1 0");
  expect_refused({"poses.txt:3", "no rotation", "det 2"});
  replace_line("poses.txt", 3, "1 0 0 0 0 1 0 nan 0 0 1 0");
  expect_refused({"poses.txt:3", "nan"});
  replace_line("poses.txt", 3, "1 0 0 0 0 1 0");
  expect_refused({"poses.txt:3", "7 values"});
}

TEST_F(DriveBadInput, TumPoses) {
  replace_line("odometry.tum", 3, "1403636579.9 0 0 0 0 0 0 2");
  expect_refused({"odometry.tum:3", "length 2"});
  replace_line("odometry.tum", 3, "1403636579.1 0 0 0 0 0 0 1");
  expect_refused({"odometry.tum:3", "does not follow"});
  write_text(place() / "odometry.tum", "# nothing\n");
  expect_refused({"odometry.tum", "no pose"});
}

TEST_F(DriveBadInput, Times) {
  const std::string times = test::read_text(place() / "times.txt");
  replace_line("times.txt", 3, "1403636579.8");
  expect_refused({"times.txt:3", "1403636579.8", "does not follow"});
  write_text(place() / "times.txt", times.substr(0, times.find('\n') + 1));
  expect_refused({"times.txt", "1 times for 5 frames"});
}

TEST_F(DriveBadInput, GapsAreSaid) {
  std::string text;
  for (const char* time : {"0.0", "0.1", "0.2", "0.3", "0.9"}) text += std::string(time) + "\n";
  write_text(place() / "times.txt", text);
  fs::remove(place() / "odometry.tum");
  const Drive drive = open_drive(place());
  ASSERT_EQ(drive.notes.size(), 1U);
  EXPECT_NE(drive.notes[0].find("after frame 3"), std::string::npos) << drive.notes[0];
  EXPECT_NE(drive.notes[0].find("6.0 times"), std::string::npos) << drive.notes[0];
}

TEST_F(DriveBadInput, PosesOfAnotherFrame) {
  DriveReadOptions options;
  options.pose_frame = PoseFrame::kCamera;  // of odometry.tum, which is the robot's
  options.poses = place() / "odometry.tum";
  write_text(place() / "mounting.yaml", "camera_height_m: 1.5\n");
  // x forward taken as the camera's x is a drive to the right.
  const Drive drive = open_drive(place(), options);
  ASSERT_FALSE(drive.notes.empty());
  EXPECT_NE(drive.notes[0].find("x-forward, z-up"), std::string::npos) << drive.notes[0];

  // z forward taken as the robot's z is a flight.
  std::string text;
  for (int i = 0; i < 5; ++i) {
    text += to_string(test::small_stamp(i)) + " 0 0 " + std::to_string(i) + " 0 0 0 1\n";
  }
  write_text(place() / "odometry.tum", text);
  expect_refused({"odometry.tum", "z-forward, y-down", "4.0 m up", "--pose-frame camera"});

  // KITTI rows of an x-forward frame.
  text.clear();
  for (int i = 0; i < 5; ++i) text += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
  write_text(place() / "poses.txt", text);
  fs::remove(place() / "odometry.tum");
  expect_refused({"poses.txt", "x-forward, z-up", "4.0 m sideways", "--pose-frame robot"});
}

TEST_F(DriveBadInput, Mounting) {
  write_text(place() / "mounting.yaml", "camera_hight_m: 1\n");
  expect_refused({"mounting.yaml:1", "camera_hight_m", "camera_height_m"});
  write_text(place() / "mounting.yaml",
             "robot_from_camera:\n  translation_m: [1, 2]\n  rotation_xyzw: [0, 0, 0, 1]\n");
  expect_refused({"mounting.yaml:2", "translation_m", "3 numbers"});
}

TEST_F(DriveBadInput, FramesThatAreNotThere) {
  DriveReadOptions options;
  options.first = 5;
  expect_error(ErrorKind::kUsage, {"--first 5", "5 frames, 0 to 4"},
               [&] { open_drive(place(), options); });
}

TEST_F(DriveBadInput, Scans) {
  const fs::path lidar = folder_ / "lidar";
  test::write_small_lidar(lidar);
  const fs::path scan = lidar / "velodyne" / "000001.bin";
  const auto read = [&](std::vector<std::string>& notes) {
    const Drive drive = open_drive(lidar);
    return drive.read_lidar(drive.frames[1], notes);
  };
  fs::resize_file(scan, fs::file_size(scan) - 7);
  std::vector<std::string> notes;
  EXPECT_EQ(read(notes).points.size(), 49U);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("9 bytes"), std::string::npos) << notes[0];
  write_text(scan, kLfsPointer);
  expect_error(ErrorKind::kInput, {"000001.bin", "git lfs pull"}, [&] { read(notes); });
  fs::remove(scan);
  expect_error(ErrorKind::kInput, {"image_2/000001.png", "no partner"}, [&] { read(notes); });
}

TEST(PoseFile, RoundTripsTumInSpace) {
  const TemporaryFolder folder;
  std::vector<StampedOdomPose3> written;
  for (int i = 0; i < 30; ++i) written.push_back({test::small_stamp(i), test::small_pose(7 * i)});
  write_tum(folder / "a.tum", written);
  const PoseFile file = read_pose_file(folder / "a.tum");
  EXPECT_EQ(file.kind, PoseFileKind::kTum);
  ASSERT_EQ(file.poses.size(), written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    EXPECT_EQ(*file.poses[i].stamp, written[i].stamp);
    const auto& [rotation, translation] = file.poses[i].world_from_sensor;
    EXPECT_LT((translation - written[i].odom_from_robot.translation).norm(), 1e-8);
    EXPECT_LT(rotation.angularDistance(written[i].odom_from_robot.rotation), 1e-8);
  }
}

/// OpenCV's own parser ends a stack of 8 MB at some tens of thousands of levels, or never ends.
TEST(OpencvYaml, RefusesWhatOpencvCannotParse) {
  const TemporaryFolder folder;
  for (const std::string sign : {"[", "{", "- ", "a: ", "? "}) {
    std::string text = "%YAML:1.0\n---\nM1: ";
    for (int i = 0; i < 200'000; ++i) text += sign;
    write_text(folder / "stereo.yml", text);
    expect_error(ErrorKind::kInput, {"stereo.yml"},
                 [&] { read_opencv_rig({folder / "stereo.yml"}); });
  }
  write_text(folder / "stereo.yml", "%YAML:1.0\n---%YAML:1.0\n--\n-\nMP1:\n");
  expect_error(ErrorKind::kInput, {"stereo.yml"},
               [&] { read_opencv_rig({folder / "stereo.yml"}); });
  write_text(folder / "stereo.yml",
             "%YAML:1.0\n---\nM1: !!opencv-matrix\n  rows: 3\n  cols: 3\n  data: [1, 2]\n");
  expect_error(ErrorKind::kInput, {"stereo.yml:3", "does not hold rows x cols numbers"},
               [&] { read_opencv_rig({folder / "stereo.yml"}); });
  write_text(folder / "stereo.yml", "<?xml version=\"1.0\"?><opencv_storage></opencv_storage>");
  expect_error(ErrorKind::kInput, {"stereo.yml", "%YAML:1.0"},
               [&] { read_opencv_rig({folder / "stereo.yml"}); });
}

}  // namespace
}  // namespace nadir
