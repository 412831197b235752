// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_drive.hpp"

// calib.txt, times.txt and poses.txt of a KITTI odometry drive of four frames.
NADIR_FUZZ_TARGET(drive_kitti) {
  for (const char* camera : {"image_0", "image_1"}) {
    for (const char* name : {"000000", "000001", "000002", "000003"}) {
      nadir::fuzz::small_image(std::string("kitti/") + camera + "/" + name + ".png");
    }
  }
  const auto parts = nadir::fuzz::parts_of(input, 3);
  nadir::fuzz::as_file("kitti/calib.txt", parts[0]);
  nadir::fuzz::as_file("kitti/times.txt", parts[1]);
  nadir::fuzz::as_file("kitti/poses.txt", parts[2]);
  nadir::fuzz::require_drive("kitti");
}
