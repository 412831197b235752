// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/mounting_file.hpp"

NADIR_FUZZ_TARGET(mounting) {
  const nadir::Mounting mounting =
      nadir::read_mounting(nadir::fuzz::as_file("mounting.yaml", input));
  if (mounting.robot_from_camera) nadir::fuzz::require_pose(*mounting.robot_from_camera);
  if (mounting.robot_from_lidar) nadir::fuzz::require_pose(*mounting.robot_from_lidar);
}
