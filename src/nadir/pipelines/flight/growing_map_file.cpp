// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/growing_map_file.hpp"

#include <nlohmann/json.hpp>

#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;

constexpr int kMostVersions = 1'000'000'000;  ///< a photo each

struct Update {
  int version = 0;
  bool final = true;
};

/// Of a map without update: final. The file is replaced at once, so that it is always whole.
Update read_update(const fs::path& map) {
  const fs::path file = update_file(map);
  if (!is_file(file)) return {};
  const auto document = nlohmann::json::parse(read_file(file), nullptr, false);
  const auto item = [&](const char* key) {
    return document.is_object() ? document.value(key, nlohmann::json()) : nlohmann::json();
  };
  const nlohmann::json version = item("version");
  const nlohmann::json final = item("final");
  if (!version.is_number_integer() || !final.is_boolean()) {
    throw input_error(file, "it is no update of a map", "delete it where the map is finished");
  }
  return {checked_integer(version.get<double>(), "its version", file.string(), 0, kMostVersions),
          final.get<bool>()};
}

}  // namespace

fs::path update_file(const fs::path& map) {
  return map.parent_path() / (map.stem().string() + ".update.json");
}

bool is_growing(const fs::path& map) { return !read_update(map).final; }

GrowingMapFile::GrowingMapFile(fs::path map) : map_(std::move(map)) {
  const Update update = read_update(map_);
  version_ = update.version;
  final_ = update.final;
}

std::optional<Orthomosaic> GrowingMapFile::newer() {
  if (final_) return std::nullopt;
  Update update = read_update(map_);
  if (update.version == version_) return std::nullopt;
  // The map is written before its update: it is of this version or a newer one.
  Orthomosaic map = read_orthomosaic(map_);
  version_ = update.version;
  final_ = update.final;
  return map;
}

}  // namespace nadir
