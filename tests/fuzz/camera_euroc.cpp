// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/detail/camera_yaml.hpp"

NADIR_FUZZ_TARGET(camera_euroc) {
  const auto camera = nadir::read_euroc_camera(nadir::fuzz::as_file("sensor.yaml", input));
  nadir::fuzz::require_pose(camera.body_from_camera);
  nadir::fuzz::require(camera.model.width > 0 && camera.model.height > 0,
                       "a camera without a size");
}
