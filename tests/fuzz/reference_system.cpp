// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/maps/metric_frame.hpp"

// The line that names a reference system, and points in it.
NADIR_FUZZ_TARGET(reference_system) {
  const double x = nadir::fuzz::taken<float>(input);
  const double y = nadir::fuzz::taken<float>(input);
  const std::string text(input);
  const auto zone = nadir::utm_zone_at(text, x, y);
  nadir::fuzz::require(!zone || std::abs(*zone) <= 60, "no UTM zone");
  const nadir::GeodeticPosition place =
      nadir::GeodeticReader(text, "line 1").read(x, y, 0, "line 2");
  nadir::fuzz::require(std::isfinite(place.latitude_deg + place.longitude_deg), "no place");
}
