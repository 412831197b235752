// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "nadir/io/photos/photo_poses.hpp"
#include "nadir/pipelines/flight/flight_input.hpp"

namespace nadir {

/// Gives the photos of the set the poses of a file; photos without one are left out, and said.
/// Poses of a frame of their own are fitted to the photos' positions. Throws Error (usage) where no
/// photo has a pose, or the poses cannot be placed.
void add_poses(const std::filesystem::path& file, FlightInput& input);
void add_poses(ImportedPoses imported, const std::string& origin, FlightInput& input);

}  // namespace nadir
