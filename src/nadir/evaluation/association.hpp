// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/core/trajectory.hpp"
#include "nadir/evaluation/evaluation_options.hpp"

namespace nadir {

/// An estimate and the truth of the same instant.
struct PosePair {
  Stamp stamp;            ///< of the truth
  Stamp estimated_stamp;  ///< at most `t_max_diff_s` away
  Pose2 estimated;
  Pose2 truth;
};

/// What there is to judge: every true pose of the range, and the estimates that belong to them.
struct Association {
  std::vector<PosePair> pairs;  ///< by rising stamp
  int truth_frames = 0;         ///< in the range, answered or not
  Stamp start;                  ///< of the first truth in the range
};

/// Pairs poses that are each other's nearest in time and at most `t_max_diff_s` apart. Throws
/// Error: (input) where a trajectory is empty, has a pose that is not finite or stamps that do not
/// increase, where no truth lies in the range, or no estimate belongs to any truth; (usage) for
/// options that make no sense.
Association associate(const Trajectory& estimated, const Trajectory& truth,
                      const EvaluationOptions& options);

}  // namespace nadir
