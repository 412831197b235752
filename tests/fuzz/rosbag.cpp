// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/bags/bag_topics.hpp"
#include "nadir/io/drives/drive_reader.hpp"

NADIR_FUZZ_TARGET(rosbag) {
  const std::filesystem::path file = nadir::fuzz::as_file("drive.bag", input);
  nadir::list_bag(file);
  const nadir::Drive drive = nadir::open_drive(file);
  nadir::fuzz::require(!drive.frames.empty(), "a drive without frames");
  if (drive.odometry) {
    for (const auto& pose : *drive.odometry) nadir::fuzz::require_pose(pose.odom_from_robot);
  }
  std::vector<std::string> notes;
  if (drive.is_stereo()) {
    drive.read_stereo(drive.frames.front());
  } else {
    drive.read_lidar(drive.frames.front(), notes);
  }
}
