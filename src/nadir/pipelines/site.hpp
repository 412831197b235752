// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/map_matching/options.hpp"

namespace nadir {

/// The map to use: `map` if it was given, else the site's. Throws Error (usage) where there is
/// none.
std::filesystem::path map_path(const Sequence& sequence, const std::filesystem::path& map);

/// The surface to compare heights with: `surface` if it was given, else the site's, which belongs
/// to the site's own map; nothing where another `map` is used or heights are not compared.
std::optional<std::filesystem::path> surface_path(const Sequence& sequence,
                                                  const std::filesystem::path& map,
                                                  const std::filesystem::path& surface,
                                                  Layers layers);

/// The true pose at an instant, as pose_at() has it.
std::optional<Pose2> truth_at(const Sequence& sequence, Stamp stamp);

/// The true poses from the first to the last of these frames.
Trajectory truth_of(const Sequence& sequence, const std::vector<Sequence::LocalMap>& frames);

}  // namespace nadir
