// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/resampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace nadir {
namespace {

std::vector<double> random_weights(std::uint64_t seed, std::size_t count) {
  const RandomStream random(seed, 0);
  std::vector<double> weights(count);
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    weights[i] = i % 7 == 3 ? 0.0 : std::pow(random.uniform(i), 4.0);
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

class DrawIndicesTest : public testing::TestWithParam<Resampling> {};

TEST_P(DrawIndicesTest, DrawsInProportionToTheWeights) {
  const std::vector<double> weights = random_weights(1, 50);
  constexpr std::size_t kDraws = 200'000;
  std::vector<double> counts(weights.size());
  for (const std::size_t i : draw_indices(GetParam(), weights, kDraws, RandomStream(2, 2))) {
    ASSERT_LT(i, weights.size());
    counts[i] += 1.0;
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double sigma = std::sqrt(weights[i] / kDraws);
    EXPECT_NEAR(counts[i] / kDraws, weights[i], 5.0 * sigma + 1e-12) << i;
    if (weights[i] == 0.0) {
      EXPECT_EQ(counts[i], 0.0) << i;
    }
  }
}

TEST_P(DrawIndicesTest, IsUnbiasedOverSeeds) {
  const std::vector<double> weights = {0.05, 0.15, 0.8};
  std::vector<double> counts(3);
  constexpr std::uint64_t kSeeds = 4000;
  constexpr std::size_t kDraws = 7;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    for (const std::size_t i : draw_indices(GetParam(), weights, kDraws, RandomStream(seed, 0))) {
      counts[i] += 1.0 / (kSeeds * kDraws);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(counts[i], weights[i], 0.015);
}

INSTANTIATE_TEST_SUITE_P(Methods, DrawIndicesTest,
                         testing::Values(Resampling::kSystematic, Resampling::kStratified,
                                         Resampling::kMultinomial));

TEST(DrawIndices, SystematicGivesEveryParticleItsShareToTheNextWhole) {
  const std::vector<double> weights = random_weights(3, 40);
  std::vector<int> counts(weights.size());
  for (const std::size_t i :
       draw_indices(Resampling::kSystematic, weights, 1000, RandomStream(1, 1))) {
    ++counts[i];
  }
  for (std::size_t i = 0; i < weights.size(); ++i) {
    EXPECT_LT(std::abs(counts[i] - 1000.0 * weights[i]), 1.0 + 1e-9);
  }
}

TEST(EffectiveSampleSize, ByHand) {
  EXPECT_DOUBLE_EQ(effective_sample_size(std::vector<double>{0.25, 0.25, 0.25, 0.25}), 4.0);
  EXPECT_DOUBLE_EQ(effective_sample_size(std::vector<double>{1.0, 0.0}), 1.0);
  EXPECT_EQ(effective_sample_size(std::vector<double>{0.0, 0.0}), 0.0);
}

TEST(KldParticles, GrowsWithTheSpreadAndStaysInItsBounds) {
  LocalizationOptions options;
  options.particles = 5000;
  options.min_particles = 100;
  const auto needed = [&](double half_size) {
    ParticleSet set;
    const RandomStream random(1, 0);
    for (std::uint64_t i = 0; i < 3000; ++i) {
      const auto [x, y] = random.uniform_pair(i);
      set.poses.push_back({half_size * (2 * x - 1), half_size * (2 * y - 1), 0.0});
      set.odometry_scales.push_back(1.0);
      set.weights.push_back(1.0 / 3000);
    }
    return kld_particles(set, options);
  };
  EXPECT_LT(needed(0.3), needed(1.0));
  EXPECT_LT(needed(1.0), needed(3.0));
  EXPECT_EQ(needed(50.0), 5000U);
  // Fox (2003), equation 7, for k = 5 bins: 4 / 0.04 * (1 - 1/18 + sqrt(1/18) * 2.3263)^3 = 333.
  ParticleSet five;
  for (int i = 0; i < 5; ++i) {
    five.poses.push_back({10.0 * i, 0.0, 0.0});
    five.odometry_scales.push_back(1.0);
    five.weights.push_back(0.2);
  }
  EXPECT_NEAR(static_cast<double>(kld_particles(five, options)), 332.0, 2.0);
}

}  // namespace
}  // namespace nadir
