// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/summary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

Evaluation run(double rmse_m, double max_m) {
  Evaluation evaluation;
  evaluation.ape_translation_m.rmse = rmse_m;
  evaluation.ape_translation_m.max = max_m;
  return evaluation;
}

TEST(SummaryTest, HandWorkedSeeds) {
  const std::vector<Evaluation> seeds{run(0.2, 0.9), run(0.3, 2.0), run(0.7, 2.1)};
  const SeedSummary summary = summarise(seeds);
  EXPECT_EQ(summary.seeds, 3);
  EXPECT_EQ(summary.lost, 1);  // 2.0 m is not beyond 2 m
  EXPECT_NEAR(summary.ape_rmse_m.mean, 0.4, 1e-12);
  EXPECT_NEAR(summary.ape_rmse_m.spread, std::sqrt(0.07), 1e-12);
  EXPECT_DOUBLE_EQ(summary.ape_rmse_m.lowest, 0.2);
  EXPECT_DOUBLE_EQ(summary.ape_max_m.highest, 2.1);
}

TEST(SummaryTest, OneSeedHasNoSpreadAndNoneIsRefused) {
  const std::vector<Evaluation> one{run(0.2, 0.9)};
  EXPECT_EQ(summarise(one).ape_rmse_m.spread, 0.0);
  EXPECT_THROW(summarise({}), Error);
}

}  // namespace
}  // namespace nadir
