// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/invocation.hpp"
#include "cli/streams.hpp"
#include "cli/verdict.hpp"
#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/pipelines/flight/flight_input.hpp"

namespace nadir::cli {

/// The files of a map: MAP.tif and its sisters MAP.surface.tif, MAP.views.tif and so on.
struct MapFiles {
  explicit MapFiles(const std::filesystem::path& path);
  std::filesystem::path map;
  std::filesystem::path surface;
  std::filesystem::path views;
  std::filesystem::path quality;
  std::filesystem::path poses;
  std::filesystem::path report;
  std::filesystem::path page;

  std::array<const std::filesystem::path*, 7> all() const& {
    return {&surface, &views, &quality, &poses, &report, &page, &map};
  }
  void all() const&& = delete;  // they would point to what is gone
};

/// Throws Error (usage) for a map that is no .tif, that is there already without --overwrite, or
/// that would lie in a file.
void require_new(const std::filesystem::path& map, const CommonOptions& common);
/// Throws Error (usage) for a map whose name is so long that those of its sisters would be too
/// long.
void require_room_for_sisters(const std::filesystem::path& map);
/// The folder that a map will lie in, or the nearest above it that is there already.
std::filesystem::path standing_folder_of(const std::filesystem::path& map);
/// Makes the folder of a map where it is not there, and removes what runs that were killed left of
/// it. Throws Error (processing) where it cannot.
void make_folder_of(const std::filesystem::path& map);

/// Writes the rasters and the poses. Throws Stopped between them.
void write_map_files(const MapFiles& files, const AerialMap& map);
/// Gives files that are whole other names on the same disk, replacing what is there, the map last:
/// where it is, all is. Throws Error (processing).
void move_map_files(const MapFiles& from, const MapFiles& to);

/// What of the photos and of the map must not be relied on unseen; photos that do not join it
/// among that, unless `allow_parts`.
Verdict verdict_of(const AerialMap& map, const FlightInput& input, bool allow_parts);

/// What `--json` prints: a summary.
Json summary_of(const AerialMap& map, const FlightInput& input);
/// MAP.report.json: the summary and every photo, pair, camera and control point.
Json report_of(const AerialMap& map, const FlightInput& input);
std::string text_of(const AerialMap& map, const FlightInput& input);

/// MAP.report.html: one file with pictures.
std::string report_page(const AerialMap& map, const FlightInput& input, const std::string& title);

}  // namespace nadir::cli
