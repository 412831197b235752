// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "localize_run.hpp"
#include "nadir/core/geo_reference.hpp"

namespace nadir::cli {

/// trajectory.geojson and trajectory.kml, where the map has a reference system.
void write_tracks(const std::filesystem::path& folder, const RunResult& result,
                  const GeoReference& map, const std::string& name);

}  // namespace nadir::cli
