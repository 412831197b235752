// SPDX-License-Identifier: Apache-2.0
// A bag of a drive gives what the folder of the same drive gives.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_drive.hpp"
#include "io/bag_drive.hpp"
#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/sequence.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path write_bag() {
  const fs::path file = scratch_folder() / "small.bag";
  const Drive drive = open_drive(small_drive());
  const auto& rig = std::get<StereoRig>(drive.rig);
  const Stamp first = drive.frames.front().stamp;
  test::BagWriter bag(file);
  bag.write("/left/camera_info", test::info_message(rig.left, 0.0, first, "left"));
  bag.write("/right/camera_info", test::info_message(rig.right, rig.baseline_m(), first, "right"));
  bag.write_transform("/tf_static",
                      test::transform_message(rig.robot_from_left, first, "base_link", "left"));
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const StereoFrame frame = drive.read_stereo(drive.frames[i]);
    bag.write("/left/image_rect", test::image_message(frame.left, frame.stamp, "left"));
    bag.write("/right/image_rect", test::image_message(frame.right, frame.stamp, "right"));
    const auto& [stamp, pose] = drive.odometry->at(i);
    bag.write_odometry("/odom", test::transform_message(pose, stamp, "odom", "base_link"));
  }
  bag.close();
  return file;
}

fs::path small_bag() {
  static const fs::path file = write_bag();
  return file;
}

TEST(GroundBag, IsMappedLikeTheFolder) {
  std::vector<fs::path> sites;
  for (const fs::path& input : {small_drive(), small_bag()}) {
    sites.push_back(scratch_folder() / ("site_of_" + input.filename().string()));
    const Outcome outcome = nadir({"ground", input.string(), "-o", sites.back().string(), "--every",
                                   "6f", "--progress", "none", "--json"});
    ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_EQ(Json::parse(outcome.output)["warnings"], Json::array());
  }
  const Sequence folder = read_sequence(sites[0]);
  const Sequence bag = read_sequence(sites[1]);
  ASSERT_EQ(bag.local_maps.size(), folder.local_maps.size());
  for (std::size_t i = 0; i < bag.local_maps.size(); ++i) {
    EXPECT_EQ(bag.local_maps[i].stamp, folder.local_maps[i].stamp);
    EXPECT_EQ(read_file(bag.local_maps[i].image), read_file(folder.local_maps[i].image)) << i;
    EXPECT_EQ(read_file(*bag.local_maps[i].elevation), read_file(*folder.local_maps[i].elevation));
  }
  EXPECT_EQ(read_file(sites[1] / "odometry.tum"), read_file(sites[0] / "odometry.tum"));
}

TEST(GroundBag, IsLocalizedOnTheWay) {
  const OdomPose2 start = planar(small_drive_pose(0));  // the map has the odometry's axes
  const Outcome outcome =
      nadir({"run", small_bag().string(), "-o", (scratch_folder() / "bag_run").string(), "--map",
             small_drive_map().string(), "--every", "6f", "--size", "12", "--prior",
             std::to_string(start.x) + "," + std::to_string(start.y) + "," +
                 std::to_string(degrees(start.yaw)),
             "--prior-spread", "1,2", "--progress", "none", "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json document = Json::parse(outcome.output);
  EXPECT_EQ(document["frames"], 5);
  EXPECT_EQ(document["compared"], 5);
}

TEST(GroundBag, InfoListsTopicsWithTypeCountAndRate) {
  const Outcome outcome = nadir({"info", small_bag().string(), "--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json topics = Json::parse(outcome.output)["topics"];
  EXPECT_EQ(topics.size(), 6U);
  EXPECT_EQ(topics["/left/image_rect"]["type"], "sensor_msgs/Image");
  EXPECT_EQ(topics["/left/image_rect"]["messages"], kSmallDriveFrames);
  EXPECT_EQ(topics["/left/image_rect"]["rate_hz"], 4.0);
  EXPECT_EQ(topics["/tf_static"]["rate_hz"], nullptr);
}

}  // namespace
}  // namespace nadir::testing
