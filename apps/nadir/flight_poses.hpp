// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "flight_input.hpp"
#include "nadir/io/photo_poses.hpp"

namespace nadir::cli {

/// Gives the photos of the set the poses of a file; photos without one are left out, and said.
/// Poses of a frame of their own are fitted to the photos' positions. Throws Error (usage) where no
/// photo has a pose, or the poses cannot be placed.
void add_poses(const std::filesystem::path& file, FlightInput& input);
void add_poses(ImportedPoses imported, const std::string& origin, FlightInput& input);

}  // namespace nadir::cli
