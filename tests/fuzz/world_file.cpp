// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

// The world file and the .prj beside an image.
NADIR_FUZZ_TARGET(world_file) {
  nadir::fuzz::small_image("world/map.png");
  const auto parts = nadir::fuzz::parts_of(input, 2);
  nadir::fuzz::as_file("world/map.pgw", parts[0]);
  if (parts[1].empty()) {
    nadir::fuzz::discard("world/map.prj");
  } else {
    nadir::fuzz::as_file("world/map.prj", parts[1]);
  }
  const auto map = nadir::read_orthomosaic(nadir::fuzz::scratch_folder() / "world/map.png");
  nadir::fuzz::require(map.geo.resolution > 0.0 && std::isfinite(map.geo.resolution) &&
                           std::isfinite(map.geo.west + map.geo.north),
                       "a geo-reference that is none");
}
