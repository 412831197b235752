// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/options.hpp"

namespace nadir::cpu {

/// Grey values are shifted by a mean and scaled by this before they are summed in single
/// precision: sums of squares then stay near their count, and float agrees with double to 5e-7.
inline constexpr double kGreyScale = 64.0;

/// Smallest variance, weighted and scaled, that leaves a score defined: 1 grey^2.
inline constexpr double kMinVariance = 1.0 / (kGreyScale * kGreyScale);

/// What every score but `sad` and `wncc_paper` is a function of: sums over the overlap, with the
/// weights a, of the shifted values R' = (R - map_shift) / 64 and P' = (P - local_shift) / 64.
struct Sums {
  double a = 0.0;    ///< sum a
  double r = 0.0;    ///< sum a R'
  double rr = 0.0;   ///< sum a R'^2
  double p = 0.0;    ///< sum a P'
  double pp = 0.0;   ///< sum a P'^2
  double rp = 0.0;   ///< sum a R' P'
  double wp = 0.0;   ///< sum w P / 64, for wncc alone (P unshifted)
  double wrp = 0.0;  ///< sum w R' P / 64, for wncc alone
};

struct Shifts {
  double map = 0.0;
  double local = 0.0;
};

/// The score in closed form; NaN where it is undefined.
double score_from_sums(Score score, const Sums& sums, const Shifts& shifts);

/// Whether `score` is such a function.
constexpr bool is_closed_form(Score score) {
  return score != Score::kSad && score != Score::kWnccPaper;
}

}  // namespace nadir::cpu
