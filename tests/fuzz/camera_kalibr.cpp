// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/detail/camera_yaml.hpp"

NADIR_FUZZ_TARGET(camera_kalibr) {
  const auto rig = nadir::read_kalibr_rig(nadir::fuzz::as_file("camchain.yaml", input));
  nadir::fuzz::require_pose(rig.right_from_left);
  nadir::fuzz::require(rig.left.width > 0 && rig.left.height > 0, "a camera without a size");
}
