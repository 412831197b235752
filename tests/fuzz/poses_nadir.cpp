// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_photo_poses.hpp"
#include "fuzz/fuzz_target.hpp"

NADIR_FUZZ_TARGET(poses_nadir) {
  nadir::fuzz::require_photo_poses(nadir::fuzz::as_file("map.poses.json", input));
}
