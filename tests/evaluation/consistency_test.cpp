// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/consistency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/trajectories.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

constexpr double kPositionM = 0.3;
constexpr double kYawRad = 0.02;

PoseCovariance honest() {
  return Eigen::Vector3d(kPositionM * kPositionM, kPositionM * kPositionM, kYawRad * kYawRad)
      .asDiagonal();
}

std::vector<StampedCovariance> same_for_all(const Trajectory& trajectory,
                                            const PoseCovariance& covariance) {
  std::vector<StampedCovariance> covariances;
  for (const auto& stamped : trajectory) covariances.push_back({stamped.stamp, covariance});
  return covariances;
}

/// Chi-square probability below `x`, by adding up the density in small steps.
double chi_square_below(double x, double degrees_of_freedom) {
  const double half = 0.5 * degrees_of_freedom;
  const int steps = 200000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double t = x * (i + 0.5) / steps;
    sum +=
        std::exp((half - 1.0) * std::log(t) - 0.5 * t - half * std::log(2.0) - std::lgamma(half));
  }
  return sum * x / steps;
}

TEST(ConsistencyTest, HandWorkedNees) {
  const Trajectory truth = testing::each_second({{0, 0, 0}});
  const Trajectory estimated = testing::each_second({{1, 2, 0.5}});
  PoseCovariance covariance;
  covariance << 2, 1, 0, 1, 2, 0, 0, 0, 0.25;
  // The inverse of [2 1; 1 2] is [2 -1; -1 2] / 3: (2*1 - 2*1*2 + 2*4) / 3 + 0.25 / 0.25 = 3.
  const Consistency c = consistency(estimated, same_for_all(estimated, covariance), truth, {});
  EXPECT_NEAR(c.mean_nees, 3.0, 1e-12);
  EXPECT_EQ(c.frames, 1);
  EXPECT_EQ(c.share_within_95, 1.0);
}

TEST(ConsistencyTest, BandHolds95PercentOfTheDistribution) {
  for (const int frames : {10, 50, 200}) {
    const ConsistencyBand band = consistency_band(frames);
    EXPECT_NEAR(chi_square_below(band.low * frames, 3.0 * frames), 0.025, 3e-4) << frames;
    EXPECT_NEAR(chi_square_below(band.high * frames, 3.0 * frames), 0.975, 3e-4) << frames;
  }
}

TEST(ConsistencyTest, OnlyHonestCovariancesAreInsideTheBand) {
  const Trajectory truth = testing::random_walk(5, 1000);
  const Trajectory estimated = testing::with_noise(truth, 6, kPositionM, kYawRad);
  const auto judged = [&](double factor) {
    return consistency(estimated, same_for_all(estimated, factor * honest()), truth, {});
  };
  EXPECT_TRUE(judged(1.0).inside());
  EXPECT_NEAR(judged(1.0).share_within_95, 0.95, 0.02);
  EXPECT_FALSE(judged(0.25).inside());
  EXPECT_GT(judged(0.25).mean_nees, judged(0.25).band.high);
  EXPECT_FALSE(judged(4.0).inside());
  EXPECT_LT(judged(4.0).mean_nees, judged(4.0).band.low);
}

TEST(ConsistencyTest, SingularCovariancesAreCountedAndLeftOut) {
  const Trajectory truth = testing::random_walk(5, 10);
  auto covariances = same_for_all(truth, honest());
  covariances[4].covariance.setZero();
  const Consistency c = consistency(truth, covariances, truth, {});
  EXPECT_EQ(c.frames, 9);
  EXPECT_EQ(c.singular_frames, 1);
}

TEST(ConsistencyTest, BadCovariancesAreRefused) {
  const Trajectory truth = testing::random_walk(5, 10);
  auto covariances = same_for_all(truth, honest());
  covariances.pop_back();
  EXPECT_THROW(consistency(truth, covariances, truth, {}), Error);
  covariances = same_for_all(truth, honest());
  covariances[3].covariance(0, 0) = NAN;
  EXPECT_THROW(consistency(truth, covariances, truth, {}), Error);
  covariances = same_for_all(truth, honest());
  std::swap(covariances[3], covariances[4]);
  EXPECT_THROW(consistency(truth, covariances, truth, {}), Error);
}

}  // namespace
}  // namespace nadir
