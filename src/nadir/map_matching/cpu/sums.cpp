// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/sums.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/core/score_volume.hpp"

namespace nadir::cpu {
namespace {

double zero_mean(const Sums& sums) {
  const double map_norm = sums.rr - sums.r * sums.r / sums.a;
  const double local_norm = sums.pp - sums.p * sums.p / sums.a;
  if (map_norm < kMinVariance * sums.a || local_norm < kMinVariance * sums.a)
    return kUndefinedScore;
  const double product = sums.rp - sums.r * sums.p / sums.a;
  return std::clamp(product / std::sqrt(map_norm * local_norm), -1.0, 1.0);
}

}  // namespace

double score_from_sums(Score score, const Sums& sums, const Shifts& shifts) {
  if (!(sums.a > 0.0)) return kUndefinedScore;
  if (score == Score::kZncc || score == Score::kZwncc) return zero_mean(sums);

  // The rest depends on the grey level itself: take the shifts out, R / 64 = R' + m.
  const double m = shifts.map / kGreyScale;
  const double l = shifts.local / kGreyScale;
  const double rr = sums.rr + 2.0 * m * sums.r + m * m * sums.a;
  const double pp = sums.pp + 2.0 * l * sums.p + l * l * sums.a;
  const double rp = sums.rp + m * sums.p + l * sums.r + m * l * sums.a;
  if (score == Score::kSsd) {
    const double difference = std::max(rr - 2.0 * rp + pp, 0.0);
    return -difference * kGreyScale * kGreyScale / sums.a;
  }
  if (rr <= 0.0 || pp <= 0.0) return kUndefinedScore;
  const double product = score == Score::kWncc ? sums.wrp + m * sums.wp : rp;
  return product / std::sqrt(rr * pp);
}

}  // namespace nadir::cpu
