// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <functional>
#include <string>

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/mapping_store.hpp"
#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/stop.hpp"

namespace nadir {

/// Called as the work goes on: the name of the stage and its finished share, 0 .. 1. Comes from
/// one thread at a time.
using MappingProgress = std::function<void(const std::string& stage, double share)>;

/// Names of the stages, in order, with their usual share of the whole time.
struct MappingStage {
  const char* name;
  double share;
};
inline constexpr std::array<MappingStage, 6> kMappingStages{{{"features", 0.30},
                                                             {"matching", 0.35},
                                                             {"adjustment", 0.15},
                                                             {"surface", 0.02},
                                                             {"seams", 0.06},
                                                             {"orthomosaic", 0.12}}};

/// Photos -> poses -> surface -> orthomosaic (docs/aerial-mapping.md). Shows the largest group of
/// photos that join each other; the report names the others. The bytes depend neither on the order
/// of the photos nor on the number of threads.
///
/// Photos with given poses are rectified as they are; the surface is then triangulated from their
/// features where this build can (`can_solve_poses`), and a plane otherwise.
///
/// Without positions, control points, relative altitude or metres_per_photo_pixel the map has an
/// arbitrary scale, at which one pixel of the map is one pixel of the photos, and says so:
/// ScaleSource::kNone and a warning. Without positions the map frame begins at (0, 0).
///
/// With a store, features and matches of photos that have a digest are kept in it and taken from
/// it; the map is the same.
///
/// `stop` is asked for all the time but within the features of one photo, the solution of one
/// system of equations and the seam of two photos, which take seconds where photos are large.
///
/// Throws Error (usage) for a set that contradicts itself (repeated names, a camera that is not
/// there, a size beyond max_megapixels), Error (input) for pixels of another size than the camera's
/// and Error (no result) where fewer than two photos join.
AerialMap map_photos(const PhotoSet& photos, const AerialMappingOptions& options,
                     const MappingProgress& progress = {}, MappingStore* store = nullptr,
                     const StopToken& stop = {});

/// Whether this build finds poses by itself (NADIR_WITH_SFM): features, matching, adjustment.
bool can_solve_poses();

}  // namespace nadir
