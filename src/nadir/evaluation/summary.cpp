// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/summary.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

MeanAndSpread over_seeds(std::span<const Evaluation> per_seed,
                         const std::function<double(const Evaluation&)>& number) {
  std::vector<double> values;
  for (const Evaluation& evaluation : per_seed) values.push_back(number(evaluation));
  const Statistics population = statistics(values);
  const auto count = static_cast<double>(values.size());
  const double correction = count > 1.0 ? std::sqrt(count / (count - 1.0)) : 0.0;
  return {population.mean, population.std * correction, population.min, population.max};
}

}  // namespace

SeedSummary summarise(std::span<const Evaluation> per_seed) {
  if (per_seed.empty()) throw Error(ErrorKind::kInput, "there is no run to summarise");
  SeedSummary summary;
  summary.seeds = static_cast<int>(per_seed.size());
  summary.lost = static_cast<int>(std::ranges::count_if(
      per_seed, [](const Evaluation& e) { return e.ape_translation_m.max > kLostBeyond; }));
  summary.ape_rmse_m = over_seeds(per_seed, [](const auto& e) { return e.ape_translation_m.rmse; });
  summary.ape_max_m = over_seeds(per_seed, [](const auto& e) { return e.ape_translation_m.max; });
  summary.yaw_rmse_rad = over_seeds(per_seed, [](const auto& e) { return e.ape_yaw_rad.rmse; });
  summary.share_within_half_metre =
      over_seeds(per_seed, [](const auto& e) { return e.share_within_half_metre; });
  summary.share_within_one_metre =
      over_seeds(per_seed, [](const auto& e) { return e.share_within_one_metre; });
  return summary;
}

}  // namespace nadir
