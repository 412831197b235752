// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "nadir/core/trajectory.hpp"
#include "nadir/evaluation/alignment.hpp"
#include "nadir/evaluation/evaluation_options.hpp"
#include "nadir/evaluation/statistics.hpp"

namespace nadir {

inline constexpr double kHalfMetre = 0.5;
inline constexpr double kOneMetre = 1.0;
inline constexpr double kFiveDegrees = radians(5.0);
/// From this error on, metres, a robot is lost.
inline constexpr double kLostBeyond = 2.0;

/// The error of one answered frame, after the alignment if one was asked for.
struct PoseError {
  Stamp stamp;
  double translation_m = 0.0;
  double yaw_rad = 0.0;  ///< estimated minus true, in (-pi, pi]
};

/// Estimate against truth. APE and RPE are evo's; a yaw error enters as its absolute value.
struct Evaluation {
  Statistics ape_translation_m;
  Statistics ape_yaw_rad;
  Statistics rpe_translation_m;
  Statistics rpe_angle_rad;

  /// Shares of ALL truth frames: a frame without an answer is a failure.
  double share_within_half_metre = 0.0;
  double share_within_one_metre = 0.0;
  double share_within_five_degrees = 0.0;

  int truth_frames = 0;
  int matched_frames = 0;
  int unanswered_frames = 0;  ///< truth stamps without an estimate

  /// From the first truth frame to the first after which every error stays under 1 m, seconds;
  /// nothing where the last one does not.
  std::optional<double> time_to_converge_s;
  /// How often the error rose beyond 2 m after having been under 1 m; once where it never was.
  int lost_count = 0;

  Similarity2 aligned_by;
  std::vector<PoseError> errors;  ///< of the answered frames, by stamp
};

/// Throws Error: (input) where a trajectory is empty, not finite or not sorted, where no truth lies
/// in the range or no estimate belongs to any truth; (usage) for a delta or a time difference that
/// makes no sense.
Evaluation evaluate(const Trajectory& estimated, const Trajectory& truth,
                    const EvaluationOptions& options);

}  // namespace nadir
