// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "nadir/evaluation/evaluation.hpp"

namespace nadir {

/// One number over several seeds.
struct MeanAndSpread {
  double mean = 0.0;
  double spread = 0.0;  ///< standard deviation of the sample (n - 1); 0 for one seed
  double lowest = 0.0;
  double highest = 0.0;
};

/// Several runs that differ by their seed alone.
struct SeedSummary {
  int seeds = 0;
  int lost = 0;  ///< seeds whose largest error exceeds 2 m
  MeanAndSpread ape_rmse_m;
  MeanAndSpread ape_max_m;
  MeanAndSpread yaw_rmse_rad;
  MeanAndSpread share_within_half_metre;
  MeanAndSpread share_within_one_metre;
};

/// Throws Error (input) where there is nothing to summarise.
SeedSummary summarise(std::span<const Evaluation> per_seed);

}  // namespace nadir
