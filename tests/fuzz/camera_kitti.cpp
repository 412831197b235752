// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"

NADIR_FUZZ_TARGET(camera_kitti) {
  const nadir::KittiCalibration calibration(nadir::fuzz::as_file("calib.txt", input));
  calibration.projections();
  const nadir::StereoRig rig =
      nadir::kitti_stereo_rig(calibration, calibration.first_of({"P2", "P0", "P_rect_02"}),
                              calibration.first_of({"P3", "P1", "P_rect_03"}), {});
  nadir::fuzz::require_pose(rig.right_from_left);
  nadir::fuzz::require_pose(rig.robot_from_left);
}
