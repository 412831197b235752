// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/photos/control_points.hpp"

NADIR_FUZZ_TARGET(control_points) {
  for (const auto& point :
       nadir::read_control_points(nadir::fuzz::as_file("gcp_list.txt", input))) {
    nadir::fuzz::require(!point.marks.empty(), "a point without marks");
    nadir::fuzz::require(std::isfinite(point.position.latitude_deg + point.position.longitude_deg +
                                       point.position.altitude_m),
                         "a place is not finite");
  }
}
