// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/photos/position_list.hpp"

NADIR_FUZZ_TARGET(positions) {
  for (const auto& listed : nadir::read_positions(nadir::fuzz::as_file("geo.txt", input))) {
    const nadir::GeodeticPosition& place = listed.position;
    nadir::fuzz::require(std::isfinite(place.latitude_deg + place.longitude_deg + place.altitude_m),
                         "a place is not finite");
  }
}
