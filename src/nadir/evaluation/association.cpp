// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/association.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

/// Unsigned, as the two ends of the range of stamps are further apart than a signed number says.
std::uint64_t distance_ns(Stamp a, Stamp b) {
  const auto later = static_cast<std::uint64_t>(std::max(a, b).nanoseconds);
  return later - static_cast<std::uint64_t>(std::min(a, b).nanoseconds);
}

void require_sensible(const EvaluationOptions& options) {
  if (!(options.t_max_diff_s >= 0.0) || !std::isfinite(options.t_max_diff_s)) {
    throw Error(ErrorKind::kUsage, "t_max_diff must be a time of 0 seconds or more");
  }
  if (!(options.rpe_delta > 0.0) || !std::isfinite(options.rpe_delta)) {
    throw Error(ErrorKind::kUsage, "delta must be larger than 0");
  }
  if (options.rpe_delta_unit == DeltaUnit::kFrames &&
      options.rpe_delta != std::floor(options.rpe_delta)) {
    throw Error(ErrorKind::kUsage, "a delta in frames must be a whole number");
  }
}

Trajectory in_range(const Trajectory& truth, const EvaluationOptions& options) {
  Trajectory kept;
  std::ranges::copy_if(truth, std::back_inserter(kept), [&](const auto& stamped) {
    return (!options.first || stamped.stamp >= *options.first) &&
           (!options.last || stamped.stamp <= *options.last);
  });
  if (kept.empty()) {
    throw Error(ErrorKind::kInput, "no pose lies in the range of frames", "truth",
                "widen the range");
  }
  return kept;
}

/// `name` ("estimate", "truth") leads the message.
void require_sound(const Trajectory& trajectory, const std::string& name) {
  if (trajectory.empty()) throw Error(ErrorKind::kInput, "it has no pose", name);
  for (std::size_t i = 0; i < trajectory.size(); ++i) {
    const std::string where = name + ", stamp " + to_string(trajectory[i].stamp);
    if (!trajectory[i].pose.is_finite()) {
      throw Error(ErrorKind::kInput, "the pose is not finite", where, "remove that line");
    }
    if (i > 0 && trajectory[i].stamp <= trajectory[i - 1].stamp) {
      throw Error(ErrorKind::kInput, "the stamp does not increase", where,
                  "sort the poses by stamp and remove doubles");
    }
  }
}

/// Position of the pose nearest in time, where it is at most `largest_difference_ns` away.
std::optional<std::size_t> nearest_in_time(const Trajectory& trajectory, Stamp stamp,
                                           std::uint64_t largest_difference_ns) {
  auto nearest = std::ranges::lower_bound(trajectory, stamp, {}, &StampedPose<frames::Map>::stamp);
  if (nearest == trajectory.end() ||
      (nearest != trajectory.begin() &&
       distance_ns(std::prev(nearest)->stamp, stamp) <= distance_ns(nearest->stamp, stamp))) {
    --nearest;
  }
  if (distance_ns(nearest->stamp, stamp) > largest_difference_ns) return std::nullopt;
  return static_cast<std::size_t>(nearest - trajectory.begin());
}

}  // namespace

Association associate(const Trajectory& estimated, const Trajectory& truth,
                      const EvaluationOptions& options) {
  require_sensible(options);
  require_sound(estimated, "estimate");
  require_sound(truth, "truth");
  const Trajectory judged = in_range(truth, options);
  Association association{{}, static_cast<int>(judged.size()), judged.front().stamp};
  // Compared as integers: 0.01 s is 10,000,000 ns, and a distance of exactly that much counts.
  const auto largest_ns = static_cast<std::uint64_t>(std::llround(options.t_max_diff_s * 1e9));
  for (std::size_t i = 0; i < judged.size(); ++i) {
    const auto j = nearest_in_time(estimated, judged[i].stamp, largest_ns);
    if (!j) continue;
    const StampedPose<frames::Map>& answer = estimated[*j];
    // Truth is often denser than the estimate: each estimate answers for one instant only.
    if (nearest_in_time(judged, answer.stamp, largest_ns) != i) continue;
    association.pairs.push_back({judged[i].stamp, answer.stamp, answer.pose, judged[i].pose});
  }
  if (association.pairs.empty()) {
    throw Error(ErrorKind::kInput, "no estimate has the stamp of a true pose", "estimate",
                "check that both files use the same clock, or raise t_max_diff");
  }
  return association;
}

}  // namespace nadir
