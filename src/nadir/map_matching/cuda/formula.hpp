// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

#include "nadir/map_matching/cuda/host_device.hpp"

namespace nadir::cuda {

/// The scores of nadir::Score by what they sum; the weights of the pixels tell zncc from zwncc.
enum class Formula { kSsd, kSad, kCosine, kWeightedCosine, kPaper, kZeroMean };

struct Rule {
  Formula formula = Formula::kZeroMean;
  bool whole_square = false;  ///< holes take part, as white pixels
  double min_share = 0.0;     ///< of the template's weight that must be compared
};

/// Grey levels are shifted by a mean and divided by this before they are summed, so that single
/// precision agrees with double to 5e-7.
inline constexpr float kGreyScale = 64.0F;
/// The grey of a hole where holes take part.
inline constexpr float kWhite = 255.0F;
/// Rounding must not lose a place where the share is exactly the limit.
inline constexpr double kShareSlack = 1e-6;

struct Shifts {
  float map = 0.0F;
  float local = 0.0F;
};

/// A pixel of the template and what lies below it.
struct Pair {
  float map = 0.0F;     ///< R, grey
  float local = 0.0F;   ///< P, grey
  float weight = 0.0F;  ///< w
  float part = 0.0F;    ///< a: its weight in means and norms
};

/// Sums over pairs, in units of kGreyScale: R' and P' are shifted and scaled. What a formula does
/// not need stays 0.
template <class T>
struct Sums {
  T seen = 0;      ///< weight of the seen template pixels on seen map
  T a = 0;         ///< sum a
  T r = 0;         ///< sum a R'
  T rr = 0;        ///< sum a R'^2
  T p = 0;         ///< sum a P'
  T pp = 0;        ///< sum a P'^2
  T rp = 0;        ///< sum a R' P'; of the weighted cosine, sum w R P
  T distance = 0;  ///< sum a |R - P| or a (R - P)^2; of [5], sum w |R - Rm| |P - Pm|
};

template <class T, class U>
NADIR_HOST_DEVICE inline void add(Sums<T>& to, const Sums<U>& from) {
  to.seen += from.seen;
  to.a += from.a;
  to.r += from.r;
  to.rr += from.rr;
  to.p += from.p;
  to.pp += from.pp;
  to.rp += from.rp;
  to.distance += from.distance;
}

template <Formula Which>
NADIR_HOST_DEVICE inline void add_pair(Sums<float>& sums, const Pair& pair, const Shifts& shifts) {
  sums.a += pair.part;
  if constexpr (Which == Formula::kSad || Which == Formula::kSsd) {
    const float difference = (pair.map - pair.local) / kGreyScale;
    sums.distance +=
        pair.part * (Which == Formula::kSad ? fabsf(difference) : difference * difference);
    return;
  }
  const float r = (pair.map - shifts.map) / kGreyScale;
  const float p = (pair.local - shifts.local) / kGreyScale;
  const float ar = pair.part * r;
  const float ap = pair.part * p;
  sums.rr += ar * r;
  sums.pp += ap * p;
  if constexpr (Which == Formula::kZeroMean || Which == Formula::kPaper) {
    sums.r += ar;
    sums.p += ap;
  }
  if constexpr (Which == Formula::kWeightedCosine) sums.rp += pair.weight * r * p;
  if constexpr (Which == Formula::kCosine || Which == Formula::kZeroMean) sums.rp += ar * p;
}

/// What equation [5] needs of a first pass over the pixels, in units of kGreyScale; `product` is
/// NaN where the score is undefined.
struct PaperMoments {
  float map_mean = 0.0F;    ///< of R'
  float local_mean = 0.0F;  ///< of P'
  double product = 0.0;     ///< sqrt(sum (R - Rm)^2 sum (P - Pm)^2)
};

NADIR_HOST_DEVICE inline void add_deviation(float& sum, const Pair& pair, const Shifts& shifts,
                                            const PaperMoments& moments) {
  const float r = (pair.map - shifts.map) / kGreyScale - moments.map_mean;
  const float p = (pair.local - shifts.local) / kGreyScale - moments.local_mean;
  sum += pair.weight * fabsf(r) * fabsf(p);
}

NADIR_HOST_DEVICE inline double undefined() { return nan(""); }

/// Variances and norms below 1 grey^2 a pixel leave a score undefined.
NADIR_HOST_DEVICE inline double min_variance() {
  return 1.0 / (static_cast<double>(kGreyScale) * static_cast<double>(kGreyScale));
}

NADIR_HOST_DEVICE inline PaperMoments paper_moments(const Sums<double>& sums) {
  if (!(sums.a > 0.0)) return {0.0F, 0.0F, undefined()};
  const double map_norm = sums.rr - sums.r * sums.r / sums.a;
  const double local_norm = sums.pp - sums.p * sums.p / sums.a;
  const bool flat = map_norm < min_variance() * sums.a || local_norm < min_variance() * sums.a;
  return {static_cast<float>(sums.r / sums.a), static_cast<float>(sums.p / sums.a),
          flat ? undefined() : sqrt(map_norm * local_norm)};
}

NADIR_HOST_DEVICE inline double zero_mean_score(const Sums<double>& sums) {
  const double map_norm = sums.rr - sums.r * sums.r / sums.a;
  const double local_norm = sums.pp - sums.p * sums.p / sums.a;
  if (map_norm < min_variance() * sums.a || local_norm < min_variance() * sums.a) {
    return undefined();
  }
  const double score = (sums.rp - sums.r * sums.p / sums.a) / sqrt(map_norm * local_norm);
  return score > 1.0 ? 1.0 : score < -1.0 ? -1.0 : score;
}

/// The score of sums that add_pair() made; NaN where it is undefined. For [5], `sums.distance` over
/// the product of `moments`.
NADIR_HOST_DEVICE inline double score_of(Formula formula, const Sums<double>& sums) {
  if (!(sums.a > 0.0)) return undefined();
  const double scale = kGreyScale;
  switch (formula) {
    case Formula::kSsd:
      return -sums.distance * scale * scale / sums.a;
    case Formula::kSad:
      return -sums.distance * scale / sums.a;
    case Formula::kZeroMean:
      return zero_mean_score(sums);
    case Formula::kPaper:
      return sums.distance / paper_moments(sums).product;
    case Formula::kCosine:
    case Formula::kWeightedCosine:
      break;
  }
  return sums.rr > 0.0 && sums.pp > 0.0 ? sums.rp / sqrt(sums.rr * sums.pp) : undefined();
}

/// The share of the template's weight that was compared.
NADIR_HOST_DEVICE inline double share_of(double seen, double total_seen) {
  if (!(total_seen > 0.0)) return 0.0;
  const double share = seen / total_seen;
  return share < 0.0 ? 0.0 : share > 1.0 ? 1.0 : share;
}

NADIR_HOST_DEVICE inline bool is_enough(const Rule& rule, double share) {
  return share >= rule.min_share - kShareSlack;
}

}  // namespace nadir::cuda
