// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/evaluation/relative_error.hpp"

namespace nadir {
namespace {

std::vector<PoseError> pose_errors(std::span<const PosePair> pairs) {
  std::vector<PoseError> errors;
  for (const PosePair& pair : pairs) {
    errors.push_back({pair.stamp,
                      std::hypot(pair.estimated.x - pair.truth.x, pair.estimated.y - pair.truth.y),
                      wrap_angle(pair.estimated.yaw - pair.truth.yaw)});
  }
  return errors;
}

std::optional<double> time_to_converge(std::span<const PoseError> errors, Stamp start) {
  const PoseError* converged = nullptr;
  for (const PoseError& error : errors) {
    if (!(error.translation_m < kOneMetre)) {
      converged = nullptr;
    } else if (converged == nullptr) {
      converged = &error;
    }
  }
  if (converged == nullptr) return std::nullopt;
  return Stamp{converged->stamp.nanoseconds - start.nanoseconds}.seconds();
}

int lost_count(std::span<const PoseError> errors) {
  int count = 0;
  bool found = false;
  bool ever_found = false;
  bool ever_beyond = false;
  for (const PoseError& error : errors) {
    if (error.translation_m < kOneMetre) found = ever_found = true;
    if (error.translation_m > kLostBeyond) ever_beyond = true;
    if (found && error.translation_m > kLostBeyond) {
      ++count;
      found = false;
    }
  }
  return !ever_found && ever_beyond ? 1 : count;
}

void add_absolute_errors(Evaluation& evaluation) {
  std::vector<double> translations;
  std::vector<double> yaws;
  for (const PoseError& error : evaluation.errors) {
    translations.push_back(error.translation_m);
    yaws.push_back(std::abs(error.yaw_rad));
  }
  evaluation.ape_translation_m = statistics(translations);
  evaluation.ape_yaw_rad = statistics(yaws);

  const auto share = [&](const std::vector<double>& values, double limit) {
    const auto within = std::ranges::count_if(values, [=](double v) { return v <= limit; });
    return static_cast<double>(within) / evaluation.truth_frames;
  };
  evaluation.share_within_half_metre = share(translations, kHalfMetre);
  evaluation.share_within_one_metre = share(translations, kOneMetre);
  evaluation.share_within_five_degrees = share(yaws, kFiveDegrees);
}

}  // namespace

Evaluation evaluate(const Trajectory& estimated, const Trajectory& truth,
                    const EvaluationOptions& options) {
  Association association = associate(estimated, truth, options);
  std::vector<PosePair>& pairs = association.pairs;

  Evaluation evaluation;
  evaluation.truth_frames = association.truth_frames;
  evaluation.matched_frames = static_cast<int>(pairs.size());
  evaluation.unanswered_frames = evaluation.truth_frames - evaluation.matched_frames;
  evaluation.aligned_by = align(pairs, options.alignment);
  for (PosePair& pair : pairs) pair.estimated = evaluation.aligned_by * pair.estimated;

  evaluation.errors = pose_errors(pairs);
  add_absolute_errors(evaluation);
  const RelativeErrors relative = relative_errors(pairs, options.rpe_delta, options.rpe_delta_unit);
  evaluation.rpe_translation_m = statistics(relative.translation_m);
  evaluation.rpe_angle_rad = statistics(relative.angle_rad);
  evaluation.time_to_converge_s = time_to_converge(evaluation.errors, association.start);
  evaluation.lost_count = lost_count(evaluation.errors);
  return evaluation;
}

}  // namespace nadir
