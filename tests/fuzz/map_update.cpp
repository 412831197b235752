// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"
#include "nadir/pipelines/flight/growing_map_file.hpp"

// MAP.update.json of a map that grows.
NADIR_FUZZ_TARGET(map_update) {
  nadir::fuzz::small_site("growing");
  nadir::fuzz::as_file("growing/map.update.json", input);
  const std::filesystem::path map = nadir::fuzz::scratch_folder() / "growing/map.tif";
  nadir::is_growing(map);
  nadir::GrowingMapFile(map).newer();
}
