// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "nadir/core/trajectory.hpp"

namespace nadir {

/// Writes where the robot was, in longitude and latitude (WGS84): .geojson or .kml by extension.
/// `crs` is the reference system of the map, as WKT: the poses are in its coordinates. One line
/// through all poses, and a point for each with its stamp (s), its heading (degrees, clockwise from
/// true north) and x, y in the map. Atomic. Throws Error (usage) for another extension or without a
/// reference system, (processing) where it cannot be written.
void write_track(const std::filesystem::path& path, const Trajectory& trajectory,
                 const std::string& crs, const std::string& name);

}  // namespace nadir
