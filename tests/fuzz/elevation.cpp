// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_raster.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/maps/elevation_file.hpp"

NADIR_FUZZ_TARGET(elevation) {
  const std::filesystem::path file = nadir::fuzz::as_file("surface.tif", input);
  if (!nadir::fuzz::is_small_raster(file)) return;
  nadir::looks_like_heights(file);
  const nadir::ElevationMap surface = nadir::read_elevation_map(file);
  nadir::fuzz::require(surface.geo.resolution > 0.0, "no resolution");
  for (const float height : surface.height_m.values()) {
    nadir::fuzz::require(!std::isinf(height), "an infinite height");
  }
}
