// SPDX-License-Identifier: Apache-2.0
// What a user gets wrong about a drive is one line that names it and the cure, the right exit code,
// and nothing half-written. tests/io/drive_bad_input_test.cpp has the files in detail.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_drive.hpp"
#include "nadir/io/drives/drive_writer.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/trajectories/pose_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class GroundBadInput : public ::testing::Test {
 protected:
  GroundBadInput() {
    fs::remove_all(place_);
    fs::create_directories(place_);
    fs::remove_all(scratch_folder() / "spoiled");
    drive_ = copy_of_small_drive("spoiled");
  }

  Outcome ground(std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"ground", drive_.string(), "-o", (place_ / "site").string(),
                                       "-q"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nadir(arguments);
  }

  void expect_refused(const Outcome& outcome, int exit_code,
                      const std::vector<std::string>& parts) const {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    EXPECT_TRUE(outcome.errors.starts_with("nadir: error: ")) << outcome.errors;
    EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
    for (const std::string& part : parts) {
      EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << " in " << outcome.errors;
    }
    EXPECT_EQ(outcome.output, "");
    EXPECT_TRUE(fs::is_empty(place_)) << fs::directory_iterator(place_)->path();
  }

  void replace(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = read_file(drive_ / file);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from << " in " << file;
    write_file_as(drive_ / file, text.replace(at, from.size(), to));
  }

  std::vector<std::string> warnings_of(const Outcome& outcome, int exit_code = 0) const {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    if (outcome.exit_code != exit_code) return {};
    return Json::parse(outcome.output)["warnings"].get<std::vector<std::string>>();
  }

  fs::path place_ = scratch_folder() / "ground_place";
  fs::path drive_;
};

bool any_holds(const std::vector<std::string>& sentences, const std::string& part) {
  return std::ranges::any_of(sentences, [&](const std::string& sentence) {
    return sentence.find(part) != std::string::npos;
  });
}

TEST_F(GroundBadInput, NoPoses) {
  fs::remove(drive_ / "odometry.tum");
  fs::remove(drive_ / "poses.txt");
  expect_refused(ground(), 3, {"no poses", "--poses FILE", "TUM", "no visual odometry"});
}

TEST_F(GroundBadInput, PosesOfAnotherTime) {
  write_file_as(drive_ / "odometry.tum", "5 0 0 0 0 0 0 1\n6 1 0 0 0 0 0 1\n");
  expect_refused(ground(), 3, {"cover none of the frames", "5.0", "100.0", "clock"});
}

TEST_F(GroundBadInput, PosesOfAnotherFrame) {
  expect_refused(ground({"--poses", (drive_ / "poses.txt").string(), "--pose-frame", "robot"}), 3,
                 {"poses.txt", "z-forward", "--pose-frame camera"});
}

TEST_F(GroundBadInput, MissingPartnerAndPointer) {
  fs::remove(drive_ / "image_1" / "000007.png");
  expect_refused(ground(), 3, {"image_0/000007.png", "no partner", "24", "23"});
  write_file_as(drive_ / "image_1" / "000007.png",
                "version https://git-lfs.github.com/spec/v1\noid sha256:0\n");
  expect_refused(ground(), 3, {"frame 7", "image_1/000007.png", "git lfs pull"});
}

TEST_F(GroundBadInput, OtherSizeInTheMiddle) {
  write_png(drive_ / "image_1" / "000004.png", Raster<std::uint8_t>(300, 160, 9));
  expect_refused(ground(), 3, {"frame 4", "320 x 160", "300 x 160"});
}

TEST_F(GroundBadInput, SwappedImages) {
  fs::rename(drive_ / "image_0", drive_ / "left");
  fs::rename(drive_ / "image_1", drive_ / "image_0");
  fs::rename(drive_ / "left", drive_ / "image_1");
  expect_refused(
      ground(), 3,
      {"frame 0", "left and right are swapped", "exchange the two image folders or topics"});
}

TEST_F(GroundBadInput, BaselineInMillimetres) {
  replace("calib.txt", "-6.000000000000e+01", "-6.000000000000e+04");
  expect_refused(ground(), 3, {"millimetres"});
}

TEST_F(GroundBadInput, NoBaseline) {
  replace("calib.txt", "-6.000000000000e+01", "0");
  expect_refused(ground(), 3, {"calib.txt:2", "no baseline"});
}

TEST_F(GroundBadInput, PointsInMillimetres) {
  LidarRig rig;
  rig.robot_from_lidar.translation.z() = 1.2;
  rig.cameras.push_back({small_drive_rig().left, small_drive_rig().robot_from_left});
  drive_ = scratch_folder() / "lidar_in_millimetres";
  fs::remove_all(drive_);
  LidarDriveWriter writer(drive_, rig);
  for (int i = 0; i < 2; ++i) {
    const StereoFrame seen = small_drive_frame(i);
    const std::vector<LidarPoint> points(1000, LidarPoint{3000.0F, 100.0F, -1200.0F});
    writer.write({seen.stamp, points, {seen.left}}, small_drive_pose(i));
  }
  writer.finish();
  expect_refused(ground(), 3, {"frame 0", "median lidar range is 3233 m", "must be in metres"});
}

TEST_F(GroundBadInput, OptionsThatCannotBe) {
  expect_refused(ground({"--set", "ground_mapping.disparities=320"}), 2, {"320", "disparities"});
  expect_refused(ground({"--size", "60"}), 2, {"60 x 60 m", "51.2 x 51.2 m"});
  expect_refused(ground({"--set", "ground_mapping.grid_cells=300"}), 2, {"grid_cells", "power of"});
  expect_refused(ground({"--every", "0m"}), 2, {"--every", "1m"});
  expect_refused(ground({"--first", "24"}), 2, {"--first 24", "24 frames"});
}

TEST_F(GroundBadInput, BlindFrameIsLeftOutAndSaid) {
  for (const char* camera : {"image_0", "image_1"}) {
    write_png(drive_ / camera / "000005.png", Raster<std::uint8_t>(320, 160, 90));
  }
  const Outcome outcome = ground({"--json"});
  EXPECT_TRUE(any_holds(warnings_of(outcome), "frame skipped")) << outcome.output;
  EXPECT_NE(read_file(place_ / "site" / "frames.csv").find("\n5,101.250000000,no_points"),
            std::string::npos);
}

/// A TUM file of poses for the small drive.
void write_poses(const fs::path& file, const std::function<OdomPose3(int)>& pose_of) {
  std::vector<StampedOdomPose3> poses;
  for (int i = 0; i < kSmallDriveFrames; ++i) {
    poses.push_back({Stamp{100'000'000'000 + i * 250'000'000LL}, pose_of(i)});
  }
  write_tum(file, poses);
}

TEST_F(GroundBadInput, PosesOfAnotherDrive) {
  const fs::path wrong = drive_ / "wrong.tum";
  write_poses(wrong, [](int i) { return spatial(OdomPose2{0.9 * i, 0.0, -0.05 * i}); });
  expect_refused(ground({"--poses", wrong.string()}), 3,
                 {"wrong.tum: the poses do not fit the images", "px from where", "checked pairs",
                  "check that --poses belongs to this drive", "check_poses=off"});
  // Insisted on, they are mapped; and the odd and even frames disagree.
  const Outcome outcome = ground({"--poses", wrong.string(), "--self-check", "--json", "--set",
                                  "ground_mapping.check_poses=off"});
  EXPECT_TRUE(any_holds(warnings_of(outcome, 5), "the poses do not fit")) << outcome.output;
}

TEST_F(GroundBadInput, PosesInMillimetres) {
  const fs::path wrong = drive_ / "millimetres.tum";
  write_poses(wrong, [](int i) {
    OdomPose3 pose = small_drive_pose(i);
    pose.translation *= 1000.0;
    return pose;
  });
  expect_refused(ground({"--poses", wrong.string()}), 3,
                 {"millimetres.tum", "the poses move by 520 m from frame to frame, 2080 m/s",
                  "millimetres? Give metres"});
}

TEST_F(GroundBadInput, PosesALittleOffAreWarnedOf) {
  const fs::path wrong = drive_ / "short.tum";
  write_poses(wrong, [](int i) {
    OdomPose3 pose = small_drive_pose(i);
    pose.translation *= 0.4;
    return pose;
  });
  const auto warnings = warnings_of(ground({"--poses", wrong.string(), "--json"}), 5);
  EXPECT_TRUE(any_holds(warnings, "short.tum: the poses do not fit the images"))
      << nlohmann::json(warnings).dump();
}

}  // namespace
}  // namespace nadir::testing
