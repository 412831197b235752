// SPDX-License-Identifier: Apache-2.0
#include "run_tracks.hpp"

#include "nadir/io/trajectories/track_file.hpp"

namespace nadir::cli {

void write_tracks(const std::filesystem::path& folder, const RunResult& result,
                  const GeoReference& map, const std::string& name) {
  if (map.crs.empty()) return;
  for (const char* file : {"trajectory.geojson", "trajectory.kml"}) {
    write_track(folder / file, result.trajectory(), map.crs, name);
  }
}

}  // namespace nadir::cli
