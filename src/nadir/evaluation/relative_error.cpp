// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/relative_error.hpp"

#include <cmath>

namespace nadir {
namespace {

/// Where one stretch ends and the next begins.
std::vector<std::size_t> stretch_ends(std::span<const PosePair> pairs, double delta,
                                      DeltaUnit unit) {
  std::vector<std::size_t> ends;
  double travelled = 0.0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i > 0) {
      travelled += unit == DeltaUnit::kFrames ? 1.0
                                              : std::hypot(pairs[i].truth.x - pairs[i - 1].truth.x,
                                                           pairs[i].truth.y - pairs[i - 1].truth.y);
    }
    if (i == 0 || travelled >= delta) {
      ends.push_back(i);
      travelled = 0.0;
    }
  }
  return ends;
}

}  // namespace

RelativeErrors relative_errors(std::span<const PosePair> pairs, double delta, DeltaUnit unit) {
  RelativeErrors errors;
  const std::vector<std::size_t> ends = stretch_ends(pairs, delta, unit);
  for (std::size_t k = 1; k < ends.size(); ++k) {
    const PosePair& from = pairs[ends[k - 1]];
    const PosePair& to = pairs[ends[k]];
    const Motion2 true_motion = from.truth.inverse() * to.truth;
    const Motion2 estimated_motion = from.estimated.inverse() * to.estimated;
    const Motion2 difference = true_motion.inverse() * estimated_motion;
    errors.translation_m.push_back(std::hypot(difference.x, difference.y));
    errors.angle_rad.push_back(std::abs(difference.yaw));
  }
  return errors;
}

}  // namespace nadir
