// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "fuzz/fuzz_raster.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/io/maps/map_tiles.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

// A GeoTIFF, and whatever else GDAL takes it for.
NADIR_FUZZ_TARGET(orthomosaic) {
  const std::filesystem::path file = nadir::fuzz::as_file("map.tif", input);
  if (!nadir::fuzz::is_small_raster(file)) return;
  nadir::fuzz::attempt([&] {
    const nadir::Orthomosaic map = nadir::read_orthomosaic(file, nadir::PlainImageGeo{0.1});
    nadir::fuzz::require(map.width() > 0 && map.height() > 0, "a map without pixels");
    nadir::fuzz::require(map.geo.resolution > 0.0 && std::isfinite(map.geo.resolution) &&
                             std::isfinite(map.geo.west + map.geo.north),
                         "a geo-reference that is none");
  });
  nadir::MapTiles tiles(file);
  tiles.tile(0, 0, 0);
  tiles.tile(tiles.levels() - 1, 0, 0);
}
