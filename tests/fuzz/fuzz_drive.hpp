// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/drive_reader.hpp"

namespace nadir::fuzz {

/// Opens a drive and reads its first frame: stamps increase, poses are finite.
inline void require_drive(const std::string& folder) {
  const Drive drive = open_drive(scratch_folder() / folder);
  require(!drive.frames.empty(), "a drive without frames");
  for (std::size_t i = 1; i < drive.frames.size(); ++i) {
    require(drive.frames[i].stamp > drive.frames[i - 1].stamp, "stamps do not increase");
  }
  if (drive.odometry) {
    for (const auto& pose : *drive.odometry) require_pose(pose.odom_from_robot);
    if (const auto pose = pose_at(*drive.odometry, drive.frames.front().stamp)) require_pose(*pose);
  }
  std::vector<std::string> notes;
  attempt([&] {
    if (drive.is_stereo()) drive.read_stereo(drive.frames.front());
  });
  attempt([&] {
    if (!drive.is_stereo()) drive.read_lidar(drive.frames.front(), notes);
  });
}

}  // namespace nadir::fuzz
