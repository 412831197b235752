// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/orthomosaic_import.hpp"

#include <cmath>

#include "fuzz/fuzz_raster.hpp"
#include "fuzz/fuzz_target.hpp"

// A byte of options, then the map of another program.
NADIR_FUZZ_TARGET(orthomosaic_import) {
  const auto wishes = nadir::fuzz::taken<std::uint8_t>(input);
  nadir::ImportOptions options;
  options.metres_per_pixel = 0.1;
  options.most_megapixels = 4.0;  // the time that a larger one takes is no finding
  if ((wishes & 1U) != 0) options.resolution_m = 0.5;
  if ((wishes & 2U) != 0) options.collar = nadir::Collar::kWhite;
  if ((wishes & 4U) != 0) options.crs = "EPSG:32632";
  const std::filesystem::path file = nadir::fuzz::as_file("import.tif", input);
  if (!nadir::fuzz::is_small_raster(file)) return;
  const auto imported = nadir::import_orthomosaic(file, options);
  nadir::fuzz::require(imported.map.geo.resolution > 0.0, "no resolution");
}
