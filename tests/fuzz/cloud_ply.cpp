// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_cloud.hpp"
#include "fuzz/fuzz_target.hpp"

NADIR_FUZZ_TARGET(cloud_ply) {
  nadir::fuzz::require_cloud(nadir::read_point_cloud(nadir::fuzz::as_file("cloud.ply", input)),
                             input.size());
}
