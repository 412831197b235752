// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "map_files.hpp"
#include "nadir/aerial_mapping/mapping.hpp"
#include "nadir/pipelines/effective_options.hpp"
#include "nadir/pipelines/flight/flight_input.hpp"

namespace nadir::cli {

struct MapOptions {
  FlightFiles flight;
  std::filesystem::path map;
  std::string sfm = "nadir";  ///< or colmap
  bool allow_parts = false;
  bool follow = false;
  int photos = 0;        ///< --follow ends after so many; 0 = not by number
  double idle_s = 60.0;  ///< --follow ends when no photo has come for so long
  OptionSources sources;
};

/// Photos of a finished flight -> map. Returns the exit code: 5 where the map is doubtful, as where
/// not all photos join and parts are not allowed.
int map_flight(const MapOptions& options, const Invocation& invocation);

/// Writes the map's files, which appear together when all are whole, and reports it; returns the
/// exit code as map_flight does.
int write_map(AerialMap map, const FlightInput& input, const MapOptions& options,
              const CommonOptions& common);

/// Tells how far the mapping has come, with one bar over all stages.
MappingProgress mapping_progress(const CommonOptions& common);

/// Throws Error (usage) where the map is finer than half a photo's pixel, or larger than the free
/// disk; warns where it is finer than a photo's pixel.
void check_size(const AerialMappingOptions& options, const std::filesystem::path& map,
                FlightInput& input);

}  // namespace nadir::cli
