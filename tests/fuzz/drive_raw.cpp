// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_drive.hpp"

// calib_cam_to_cam.txt, calib_velo_to_cam.txt and timestamps.txt of a KITTI raw drive with a lidar.
NADIR_FUZZ_TARGET(drive_raw) {
  const std::string scan("\0\0\x80\x3f\0\0\0\x40\0\0\x40\x40\0\0\0\x3f", 16);
  for (const char* name : {"0000000000", "0000000001"}) {
    nadir::fuzz::small_image(std::string("raw/image_02/data/") + name + ".png");
    nadir::fuzz::as_file(std::string("raw/velodyne_points/data/") + name + ".bin", scan);
  }
  const auto parts = nadir::fuzz::parts_of(input, 3);
  nadir::fuzz::as_file("raw/calib_cam_to_cam.txt", parts[0]);
  nadir::fuzz::as_file("raw/calib_velo_to_cam.txt", parts[1]);
  nadir::fuzz::as_file("raw/velodyne_points/timestamps.txt", parts[2]);
  nadir::fuzz::require_drive("raw");
}
