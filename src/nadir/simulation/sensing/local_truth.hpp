// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/simulation/scene/scene.hpp"
#include "nadir/simulation/simulated_drive.hpp"

namespace nadir::simulation {

struct LocalTruth {
  Orthomosaic local;
  ElevationMap elevation;  ///< NaN where the local map is invalid
};

/// What lies around a robot, from straight above, below its ceiling. Where `seen_from` is not
/// empty, valid is what a camera of the rig sees from one of those poses.
LocalTruth local_truth(const Scene& scene, const Transform3<frames::Map, frames::Robot>& robot,
                       const LocalTruthOptions& options, const StereoRig& rig,
                       const std::vector<Transform3<frames::Map, frames::Robot>>& seen_from);

}  // namespace nadir::simulation
