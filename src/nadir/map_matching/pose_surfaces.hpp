// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// Whether MatchingOptions::pose_scoring and, for `auto`, the estimated costs speak for surfaces.
/// The same on every machine and for any number of threads.
bool takes_surfaces(const MapIndex& map, const Template& local,
                    std::span<const Pose2> map_from_robot);

/// Scores by interpolation (cubic in position, linear in heading) between the score surfaces of a
/// few headings over the window of the poses, brought to the size of exact ones by a factor that a
/// few exactly scored poses give. Poses beside undefined scores are scored exactly.
std::vector<PoseScore> score_by_surfaces(const MapIndex& map, const Template& local,
                                         std::span<const Pose2> map_from_robot,
                                         const StopToken& stop);

}  // namespace nadir
