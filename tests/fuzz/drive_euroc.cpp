// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_drive.hpp"

// sensor.yaml and data.csv of the right camera of an EuRoC drive, and its truth. The left camera's
// data.csv is that of the right one.
NADIR_FUZZ_TARGET(drive_euroc) {
  const auto parts = nadir::fuzz::parts_of(input, 3);
  for (const std::string camera : {"euroc/mav0/cam0/", "euroc/mav0/cam1/"}) {
    for (const char* name : {"1.png", "2.png", "3.png", "4.png"}) {
      nadir::fuzz::small_image(camera + "data/" + name);
    }
    nadir::fuzz::as_file(camera + "sensor.yaml", parts[0]);
    nadir::fuzz::as_file(camera + "data.csv", parts[1]);
  }
  // The left camera stands where the body is.
  nadir::fuzz::as_file("euroc/mav0/cam0/sensor.yaml",
                       "T_BS:\n  data: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]\n"
                       "resolution: [8, 6]\ncamera_model: pinhole\nintrinsics: [9, 9, 3.5, 2.5]\n");
  nadir::fuzz::as_file("euroc/mav0/state_groundtruth_estimate0/data.csv", parts[2]);
  nadir::fuzz::require_drive("euroc");
}
