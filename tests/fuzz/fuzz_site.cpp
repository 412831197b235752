// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_site.hpp"

#include "nadir/io/image.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir::fuzz {

Orthomosaic small_map(int width, int height, Point2<frames::Map> north_west) {
  Orthomosaic map{{width, height}, {width, height, 255}, {north_west.x, north_west.y, 0.5, {}}};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      map.image.at(column, row) = static_cast<std::uint8_t>((column / 3 * 37 + row / 3 * 91) % 251);
    }
  }
  return map;
}

void small_image(const std::string& name) {
  const std::filesystem::path file = scratch_folder() / name;
  if (std::filesystem::exists(file)) return;
  std::filesystem::create_directories(file.parent_path());
  write_png(file, small_map(8, 6, {0.0, 0.0}).image);
}

void small_site(const std::string& folder) {
  const std::filesystem::path site = scratch_folder() / folder;
  if (std::filesystem::exists(site / "map.tif")) return;
  std::filesystem::create_directories(site / "local");
  for (const char* name : {"local/1.tif", "local/2.tif"}) {
    write_orthomosaic(site / name, small_map(12, 12, {-3.0, 3.0}));
  }
  write_orthomosaic(site / "map.tif", small_map(60, 60, {0.0, 30.0}));
}

}  // namespace nadir::fuzz
