// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_photo_poses.hpp"
#include "fuzz/fuzz_target.hpp"

// cameras.txt and images.txt.
NADIR_FUZZ_TARGET(poses_colmap) {
  const auto parts = nadir::fuzz::parts_of(input, 2);
  nadir::fuzz::as_file("model/cameras.txt", parts[0]);
  nadir::fuzz::as_file("model/images.txt", parts[1]);
  nadir::fuzz::require_photo_poses(nadir::fuzz::scratch_folder() / "model");
}
