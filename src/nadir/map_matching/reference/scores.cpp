// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/reference/scores.hpp"

#include <cmath>

#include "nadir/core/score_volume.hpp"

namespace nadir::reference {
namespace {

constexpr double kMinVariance = 1.0;  // grey^2

/// Sum over all pairs of term(R, P, w).
template <class Term>
double sum(const PixelPairs& pairs, Term term) {
  double total = 0.0;
  for (std::size_t i = 0; i < pairs.map.size(); ++i) {
    total += term(pairs.map[i], pairs.local[i], pairs.weight[i]);
  }
  return total;
}

double mean_squared_difference(const PixelPairs& pairs) {
  return sum(pairs, [](double r, double p, double) { return (r - p) * (r - p); }) /
         static_cast<double>(pairs.map.size());
}

double mean_absolute_difference(const PixelPairs& pairs) {
  return sum(pairs, [](double r, double p, double) { return std::abs(r - p); }) /
         static_cast<double>(pairs.map.size());
}

/// ncc with all weights 1; wncc: the weight stands in the numerator alone.
double cosine(const PixelPairs& pairs, bool weighted) {
  const double product =
      sum(pairs, [=](double r, double p, double w) { return (weighted ? w : 1.0) * r * p; });
  const double map_norm = sum(pairs, [](double r, double, double) { return r * r; });
  const double local_norm = sum(pairs, [](double, double p, double) { return p * p; });
  if (map_norm <= 0.0 || local_norm <= 0.0) return kUndefinedScore;
  return product / std::sqrt(map_norm * local_norm);
}

/// Equations [2], [3] and [5].
double paper_wncc(const PixelPairs& pairs) {
  const auto count = static_cast<double>(pairs.map.size());
  const double map_mean = sum(pairs, [](double r, double, double) { return r; }) / count;
  const double local_mean = sum(pairs, [](double, double p, double) { return p; }) / count;
  const double product = sum(pairs, [=](double r, double p, double w) {
    return w * std::abs(r - map_mean) * std::abs(p - local_mean);
  });
  const double map_norm =
      sum(pairs, [=](double r, double, double) { return (r - map_mean) * (r - map_mean); });
  const double local_norm =
      sum(pairs, [=](double, double p, double) { return (p - local_mean) * (p - local_mean); });
  if (map_norm < kMinVariance * count || local_norm < kMinVariance * count) return kUndefinedScore;
  return product / std::sqrt(map_norm * local_norm);
}

/// Weights in the means and in the norms; zncc with all weights 1.
double zero_mean_ncc(const PixelPairs& pairs, bool weighted) {
  const auto w_of = [=](double w) { return weighted ? w : 1.0; };
  const double total = sum(pairs, [=](double, double, double w) { return w_of(w); });
  const double map_mean =
      sum(pairs, [=](double r, double, double w) { return w_of(w) * r; }) / total;
  const double local_mean =
      sum(pairs, [=](double, double p, double w) { return w_of(w) * p; }) / total;
  const double product = sum(pairs, [=](double r, double p, double w) {
    return w_of(w) * (r - map_mean) * (p - local_mean);
  });
  const double map_norm = sum(
      pairs, [=](double r, double, double w) { return w_of(w) * (r - map_mean) * (r - map_mean); });
  const double local_norm = sum(pairs, [=](double, double p, double w) {
    return w_of(w) * (p - local_mean) * (p - local_mean);
  });
  if (!(total > 0.0) || map_norm < kMinVariance * total || local_norm < kMinVariance * total) {
    return kUndefinedScore;
  }
  return product / std::sqrt(map_norm * local_norm);
}

}  // namespace

double score(Score score, const PixelPairs& pairs) {
  if (pairs.map.empty()) return kUndefinedScore;
  switch (score) {
    case Score::kSsd:
      return -mean_squared_difference(pairs);
    case Score::kSad:
      return -mean_absolute_difference(pairs);
    case Score::kNcc:
      return cosine(pairs, false);
    case Score::kWncc:
      return cosine(pairs, true);
    case Score::kWnccPaper:
      return paper_wncc(pairs);
    case Score::kZncc:
      return zero_mean_ncc(pairs, false);
    case Score::kZwncc:
      return zero_mean_ncc(pairs, true);
  }
  return kUndefinedScore;
}

}  // namespace nadir::reference
