// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/detail/camera_yaml.hpp"

NADIR_FUZZ_TARGET(camera_opencv) {
  const std::filesystem::path file = nadir::fuzz::as_file("stereo.yml", input);
  nadir::is_opencv_yaml(file);
  nadir::fuzz::require_pose(nadir::read_opencv_rig({file}).right_from_left);
}
