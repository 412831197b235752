// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/pose_file.hpp"
#include "fuzz/fuzz_target.hpp"

// TUM, KITTI and EuRoC, told apart by their first line.
NADIR_FUZZ_TARGET(pose_file) {
  const nadir::PoseFile file = nadir::read_pose_file(nadir::fuzz::as_file("poses.txt", input));
  nadir::fuzz::require(!file.poses.empty(), "a file without poses");
  for (const nadir::FilePose& pose : file.poses) nadir::fuzz::require_pose(pose.world_from_sensor);
}
