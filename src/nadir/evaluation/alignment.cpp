// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/alignment.hpp"

#include <cmath>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

/// What Umeyama's equations need of two point sets in the plane.
struct Moments {
  Point2<frames::Map> estimated_mean;
  Point2<frames::Map> truth_mean;
  double dot = 0.0;               ///< sum of e . t over the centred points
  double cross = 0.0;             ///< sum of e x t
  double estimated_square = 0.0;  ///< sum of |e|^2
};

Moments moments(std::span<const PosePair> pairs) {
  Moments sums;
  const auto count = static_cast<double>(pairs.size());
  for (const PosePair& pair : pairs) {
    sums.estimated_mean.x += pair.estimated.x / count;
    sums.estimated_mean.y += pair.estimated.y / count;
    sums.truth_mean.x += pair.truth.x / count;
    sums.truth_mean.y += pair.truth.y / count;
  }
  for (const PosePair& pair : pairs) {
    const double ex = pair.estimated.x - sums.estimated_mean.x;
    const double ey = pair.estimated.y - sums.estimated_mean.y;
    const double tx = pair.truth.x - sums.truth_mean.x;
    const double ty = pair.truth.y - sums.truth_mean.y;
    sums.dot += ex * tx + ey * ty;
    sums.cross += ex * ty - ey * tx;
    sums.estimated_square += ex * ex + ey * ey;
  }
  return sums;
}

Similarity2 least_squares(std::span<const PosePair> pairs, bool with_scale) {
  const Moments sums = moments(pairs);
  const double correlation = std::hypot(sums.dot, sums.cross);
  if (!(correlation > 0.0)) {
    throw Error(ErrorKind::kProcessing, "no rotation follows from positions that coincide",
                "alignment", "evaluate without alignment or over more frames");
  }
  Similarity2 result;
  result.motion.yaw = std::atan2(sums.cross, sums.dot);                // [40], [43]
  if (with_scale) result.scale = correlation / sums.estimated_square;  // [42]
  const Pose2 rotated_mean = result * Pose2{sums.estimated_mean.x, sums.estimated_mean.y, 0.0};
  result.motion.x = sums.truth_mean.x - rotated_mean.x;  // [41]
  result.motion.y = sums.truth_mean.y - rotated_mean.y;
  return result;
}

}  // namespace

std::string to_string(Alignment alignment) {
  for (const auto& [value, name] : kAlignmentNames) {
    if (value == alignment) return name;
  }
  return {};
}

Similarity2 align(std::span<const PosePair> pairs, Alignment alignment) {
  if (pairs.empty()) return {};
  switch (alignment) {
    case Alignment::kNone:
      break;
    case Alignment::kOrigin:
      return {1.0, pairs.front().truth * pairs.front().estimated.inverse()};
    case Alignment::kSe2:
      return least_squares(pairs, false);
    case Alignment::kSim2:
      return least_squares(pairs, true);
  }
  return {};
}

}  // namespace nadir
