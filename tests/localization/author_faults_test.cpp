// SPDX-License-Identifier: Apache-2.0
// One test for each fault of the filter that was found in the paper's authors' scripts. Those of
// their matching stand in tests/map_matching/author_faults_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "nadir/localization/particle_filter.hpp"
#include "nadir/localization/resampling.hpp"

namespace nadir {
namespace {

/// The paper's protocol without its noise.
LocalizationOptions plain() {
  LocalizationOptions options = LocalizationOptions::paper();
  options.roughening_m = options.roughening_deg = 0.0;
  return options;
}

TEST(AuthorFaults, NoiseAccumulatesOverTheParticleIndex) {
  LocalizationOptions options = plain();
  options.position_noise_floor_m = 0.1;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {0.0, 0.0});
  filter.predict({1.0, 0.0, 0.0});
  const auto spread = [&](std::size_t first, std::size_t last) {
    double squares = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      const double error = filter.particles().poses[i].x - 1.0;
      squares += error * error;
    }
    return std::sqrt(squares / static_cast<double>(last - first));
  };
  EXPECT_NEAR(spread(0, 500), 0.1, 0.012);
  EXPECT_NEAR(spread(500, 1000), 0.1, 0.012);
}

TEST(AuthorFaults, XAndYBothMovedByTheDistance) {
  ParticleFilter filter(plain(), 1);
  filter.start_near({1.0, 2.0, radians(90)}, {0.0, 0.0});
  filter.predict({3.0, 0.0, 0.0});  // three metres ahead, and that is north
  EXPECT_NEAR(filter.particles().poses[0].x, 1.0, 1e-12);
  EXPECT_NEAR(filter.particles().poses[0].y, 5.0, 1e-12);
}

TEST(AuthorFaults, NoYawState) {
  ParticleFilter filter(plain(), 1);
  filter.start_near({0.0, 0.0, 0.1}, {0.0, 0.0});
  filter.predict({1.0, 0.0, 0.3});
  filter.predict({1.0, 0.0, 0.3});
  EXPECT_NEAR(filter.particles().poses[0].yaw, 0.7, 1e-12);
  EXPECT_NEAR(filter.particles().poses[0].y, std::sin(0.1) + std::sin(0.4), 1e-12);
}

TEST(AuthorFaults, DegreesTakenForRadians) {
  LocalizationOptions options = plain();
  options.roughening_deg = 2.0;
  options.particles = options.start_particles = 20000;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {0.0, 0.0});
  filter.resample_if_needed();
  EXPECT_NEAR(std::sqrt(filter.clusters().front().covariance(2, 2)), 2.0 * kPi / 180.0, 1e-3);
}

TEST(AuthorFaults, ScoresAddedToOldOnesInsteadOfMultiplied) {
  ParticleFilter filter(plain(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {1.0, 0.0});
  std::vector<double> scores(1000, 0.5);
  scores[0] = 1.0;
  filter.weigh(scores);
  filter.weigh(scores);
  const auto& weights = filter.particles().weights;
  EXPECT_NEAR(weights[0] / weights[1], 4.0, 1e-9);
  EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-12);
}

TEST(AuthorFaults, ResamplerThatCopiesParticleZero) {
  // With equal weights no particle may be drawn for more than its share, particle 0 least of all.
  const std::vector<double> weights(1000, 1e-3);
  const auto indices = draw_indices(Resampling::kMultinomial, weights, 1000, RandomStream(1, 0));
  EXPECT_LT(std::count(indices.begin(), indices.end(), std::size_t{0}), 8);
}

TEST(AuthorFaults, AllZeroWeightsBecomeNaN) {
  ParticleFilter filter(plain(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {1.0, 0.1});
  EXPECT_FALSE(filter.weigh(std::vector<double>(1000, 0.0)));
  EXPECT_FALSE(filter.weigh(std::vector<double>(1000, NAN)));
  EXPECT_FALSE(filter.weigh(std::vector<double>(1000, -0.3)));
  filter.resample_if_needed();
  for (const double weight : filter.particles().weights) EXPECT_NEAR(weight, 1e-3, 1e-15);
  EXPECT_TRUE(filter.clusters().front().mean.is_finite());
}

}  // namespace
}  // namespace nadir
