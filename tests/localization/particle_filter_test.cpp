// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/particle_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

LocalizationOptions noiseless() {
  LocalizationOptions options;
  options.start_particles = options.particles;
  options.position_noise_per_m = options.position_noise_floor_m = 0.0;
  options.yaw_noise_deg_per_m = options.yaw_noise_deg_per_deg = options.yaw_noise_floor_deg = 0.0;
  options.odometry_scale_sigma = options.odometry_scale_walk = 0.0;
  return options;
}

std::vector<double> scores_near(const ParticleFilter& filter, double x, double y) {
  std::vector<double> scores;
  for (const Pose2& pose : filter.particles().poses) {
    scores.push_back(1.0 - std::hypot(pose.x - x, pose.y - y));
  }
  return scores;
}

TEST(ParticleFilter, StartsUniformInTheSquareAndTheRangeOfHeadings) {
  ParticleFilter filter(noiseless(), 1);
  filter.start_near({10.0, -5.0, 3.0}, {2.0, 0.3});
  double sum_x = 0.0;
  double square_x = 0.0;
  for (const Pose2& pose : filter.particles().poses) {
    EXPECT_LE(std::abs(pose.x - 10.0), 2.0);
    EXPECT_LE(std::abs(pose.y + 5.0), 2.0);
    EXPECT_LE(std::abs(wrap_angle(pose.yaw - 3.0)), 0.3);
    sum_x += pose.x - 10.0;
    square_x += (pose.x - 10.0) * (pose.x - 10.0);
  }
  EXPECT_NEAR(sum_x / 1000, 0.0, 0.2);
  EXPECT_NEAR(square_x / 1000, 4.0 / 3.0, 0.2);
}

TEST(ParticleFilter, NoiseHasTheDeclaredSize) {
  LocalizationOptions options = noiseless();
  options.particles = options.start_particles = 20000;
  options.position_noise_per_m = 0.1;
  options.position_noise_floor_m = 0.03;
  options.yaw_noise_deg_per_m = 0.5;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {0.0, 0.0});
  filter.predict({2.0, 0.0, 0.0});
  const Cluster cloud = filter.clusters().front();
  EXPECT_NEAR(cloud.mean.x, 2.0, 0.01);
  EXPECT_NEAR(cloud.mean.y, 0.0, 0.01);
  EXPECT_NEAR(cloud.covariance(0, 0), 0.2 * 0.2 + 0.03 * 0.03, 0.002);
  EXPECT_NEAR(cloud.covariance(1, 1), 0.2 * 0.2 + 0.03 * 0.03, 0.002);
  EXPECT_NEAR(std::sqrt(cloud.covariance(2, 2)), radians(1.0), radians(0.03));
}

TEST(ParticleFilter, LearnsASteadyScaleErrorOfTheOdometry) {
  LocalizationOptions options;
  options.start_particles = options.particles = 2000;
  ParticleFilter filter(options, 5);
  filter.start_near({0.0, 0.0, 0.0}, {0.5, 0.05});
  constexpr double kTrueScale = 1.08;
  double x = 0.0;
  for (int step = 0; step < 60; ++step) {
    filter.predict({0.5, 0.0, 0.0});
    x += kTrueScale * 0.5;
    ASSERT_TRUE(filter.weigh(scores_near(filter, x, 0.0)));
    filter.resample_if_needed();
  }
  const auto& scales = filter.particles().odometry_scales;
  const double mean =
      std::accumulate(scales.begin(), scales.end(), 0.0) / static_cast<double>(scales.size());
  EXPECT_NEAR(mean, kTrueScale, 0.03);
}

TEST(ParticleFilter, ResamplesOnlyWhenTheEffectiveSampleFalls) {
  ParticleFilter filter(noiseless(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  filter.weigh(std::vector<double>(1000, 0.7));  // says nothing
  EXPECT_NEAR(filter.effective_particles(), 1000.0, 1e-6);
  EXPECT_FALSE(filter.resample_if_needed());
  filter.weigh(scores_near(filter, 0.0, 0.0));
  EXPECT_LT(filter.effective_particles(), 500.0);
  EXPECT_TRUE(filter.resample_if_needed());
  EXPECT_NEAR(filter.effective_particles(), 1000.0, 1e-6);
}

TEST(ParticleFilter, TheDenseStartIsThinnedAtTheFirstResampling) {
  LocalizationOptions options = noiseless();
  options.start_particles = 5000;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  EXPECT_EQ(filter.particles().size(), 5000U);
  filter.weigh(scores_near(filter, 0.0, 0.0));
  EXPECT_TRUE(filter.resample_if_needed());
  EXPECT_EQ(filter.particles().size(), 1000U);
}

TEST(ParticleFilter, AdaptsTheNumberOfParticles) {
  LocalizationOptions options = noiseless();
  options.adaptive = true;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.1});
  for (int i = 0; i < 3; ++i) {
    filter.weigh(scores_near(filter, 0.0, 0.0));
    filter.resample_if_needed();
  }
  EXPECT_LT(filter.particles().size(), 1000U);
  EXPECT_GE(filter.particles().size(), 200U);
}

TEST(ParticleFilter, BoundsWhatOneFrameMayDecide) {
  LocalizationOptions options = noiseless();
  options.min_effective_share = 0.2;
  ParticleFilter filter(options, 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  filter.weigh(scores_near(filter, 0.0, 0.0));
  EXPECT_NEAR(filter.effective_particles(), 200.0, 1.0);
}

TEST(ParticleFilter, UndefinedScoresAreNoBetterThanTheWorst) {
  ParticleFilter filter(noiseless(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  std::vector<double> scores(1000, 0.5);
  scores[7] = 0.9;
  scores[8] = 0.1;
  scores[9] = NAN;
  ASSERT_TRUE(filter.weigh(scores));
  const auto& weights = filter.particles().weights;
  EXPECT_GT(weights[7], weights[8]);
  EXPECT_DOUBLE_EQ(weights[9], weights[8]);
}

// Seen on a robot that had left the map: the few particles at its rim won with a score of nothing.
TEST(ParticleFilter, AFewThatCouldBeComparedDoNotWinOverTheManyThatCouldNot) {
  ParticleFilter filter(noiseless(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  ASSERT_TRUE(filter.weigh(std::vector<double>(1000, 0.5)));
  std::vector<double> scores(1000, NAN);
  std::fill(scores.begin(), scores.begin() + 300, 0.2);
  EXPECT_FALSE(filter.weigh(scores));
  EXPECT_NEAR(filter.effective_particles(), 1000.0, 1e-6);
}

// A prior near the rim of the map: most of the first cloud may lie beyond it.
TEST(ParticleFilter, TheStartCountsWhateverShareOfItCouldBeCompared) {
  ParticleFilter filter(noiseless(), 1);
  filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.0});
  std::vector<double> scores(1000, NAN);
  std::fill(scores.begin(), scores.begin() + 100, 0.2);
  scores[5] = 0.6;
  EXPECT_TRUE(filter.weigh(scores));
  EXPECT_LT(filter.effective_particles(), 10.0);
}

TEST(ParticleFilter, SameSeedSameBytes) {
  const auto run = [](std::uint64_t seed) {
    ParticleFilter filter({}, seed);
    filter.start_near({0.0, 0.0, 0.0}, {5.0, 0.1});
    for (int i = 0; i < 5; ++i) {
      filter.predict({0.5, 0.1, 0.02});
      filter.weigh(scores_near(filter, 0.5 * i, 0.0));
      filter.resample_if_needed();
    }
    return filter.particles().poses.front().x;
  };
  EXPECT_EQ(run(4), run(4));
  EXPECT_NE(run(4), run(5));
}

TEST(ParticleFilter, RefusesAPriorThatIsNone) {
  ParticleFilter filter({}, 1);
  EXPECT_THROW(filter.start_near({NAN, 0.0, 0.0}, {5.0, 0.1}), Error);
  EXPECT_THROW(filter.start_near({0.0, 0.0, 0.0}, {-1.0, 0.1}), Error);
  EXPECT_THROW(filter.start_near({0.0, 0.0, 0.0}, {5.0, INFINITY}), Error);
}

}  // namespace
}  // namespace nadir
