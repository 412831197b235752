// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/trajectories/tum.hpp"

NADIR_FUZZ_TARGET(pose_tum) {
  const std::filesystem::path file = nadir::fuzz::as_file("track.tum", input);
  const nadir::Trajectory track = nadir::read_tum(file);
  for (std::size_t i = 0; i < track.size(); ++i) {
    nadir::fuzz::require(track[i].pose.is_finite(), "a pose is not finite");
    nadir::fuzz::require(i == 0 || track[i].stamp > track[i - 1].stamp, "stamps do not increase");
  }
  nadir::fuzz::require(nadir::read_tum_odometry(file).size() == track.size(), "two readings");
}
