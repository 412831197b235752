// SPDX-License-Identifier: Apache-2.0
#include "map_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cli/interrupt.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/file_names.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/photos/photo_poses.hpp"
#include "nadir/io/unfinished_folder.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

fs::path sister(const fs::path& map, const char* suffix) {
  return map.parent_path() / (map.stem().string() + suffix);
}

/// Where the map has no pixel there is no quality either.
ElevationMap quality_raster(const AerialMap& map) {
  ElevationMap quality{map.quality, map.ortho.geo};
  auto& values = quality.height_m.values();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (map.ortho.valid.values()[i] == 0) values[i] = std::numeric_limits<float>::quiet_NaN();
  }
  return quality;
}

Orthomosaic view_count_raster(const AerialMap& map) {
  return {map.view_count, map.view_count, map.ortho.geo};
}

}  // namespace

MapFiles::MapFiles(const fs::path& path)
    : map(path),
      surface(sister(path, ".surface.tif")),
      views(sister(path, ".views.tif")),
      quality(sister(path, ".quality.tif")),
      poses(sister(path, ".poses.json")),
      report(sister(path, ".report.json")),
      page(sister(path, ".report.html")) {}

fs::path standing_folder_of(const fs::path& map) {
  fs::path place = fs::absolute(map).parent_path();
  std::error_code unknown;
  while (!fs::exists(place, unknown) && place.has_relative_path()) place = place.parent_path();
  return place;
}

void require_new(const fs::path& map, const CommonOptions& common) {
  if (map.extension() != ".tif" && map.extension() != ".tiff") {
    throw Error(ErrorKind::kUsage, "the map is a GeoTIFF", map.string(), "give -o MAP.tif");
  }
  const fs::path place = standing_folder_of(map);
  if (!is_folder(place)) {
    throw Error(ErrorKind::kUsage, "this is a file, no folder for the map", place.string(),
                "give another -o");
  }
  std::error_code unknown;
  if (fs::exists(map, unknown) && !common.overwrite) {
    throw Error(ErrorKind::kUsage, "the map is there already", map.string(),
                "give --overwrite to replace it, or another -o");
  }
}

void require_room_for_sisters(const fs::path& map) {
  const std::size_t longest = kLongestName - std::string(".surface.tif").size();
  if (map.stem().string().size() > longest) {
    throw Error(ErrorKind::kUsage,
                "the name is too long: the files beside the map, as MAP.surface.tif, would have "
                "none",
                map.string(),
                fmt::format("give one of at most {} bytes before its ending", longest));
  }
}

void make_folder_of(const fs::path& map) {
  std::error_code error;
  if (map.has_parent_path()) fs::create_directories(map.parent_path(), error);
  if (error) {
    throw Error(ErrorKind::kProcessing, "cannot create the output folder: " + error.message(),
                map.parent_path().string(), "check the place and its rights");
  }
  const MapFiles files(map);
  for (const fs::path* file : files.all()) remove_abandoned(*file);
}

void write_map_files(const MapFiles& files, const AerialMap& map) {
  write_elevation_map(files.surface, map.surface);
  stop_if_interrupted();
  write_orthomosaic(files.views, view_count_raster(map));
  stop_if_interrupted();
  write_elevation_map(files.quality, quality_raster(map));
  stop_if_interrupted();
  write_photo_poses(files.poses, map.poses, map.ortho.geo.crs);
  write_orthomosaic(files.map, map.ortho);
}

void move_map_files(const MapFiles& from, const MapFiles& to) {
  const auto sources = from.all();
  const auto targets = to.all();
  for (std::size_t i = 0; i < sources.size(); ++i) {
    std::error_code error;
    fs::rename(*sources[i], *targets[i], error);
    if (!error) continue;
    throw Error(ErrorKind::kProcessing, "cannot be written: " + error.message(),
                targets[i]->string(), "check the folder, its permissions and the free space");
  }
}

}  // namespace nadir::cli
