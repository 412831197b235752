// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/trajectories.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

std::vector<PosePair> pairs_of(const Trajectory& estimated, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    pairs.push_back({truth[i].stamp, estimated[i].stamp, estimated[i].pose, truth[i].pose});
  }
  return pairs;
}

double squared_error(const std::vector<PosePair>& pairs, const Similarity2& similarity) {
  double sum = 0.0;
  for (const PosePair& pair : pairs) {
    const Pose2 moved = similarity * pair.estimated;
    sum += std::pow(moved.x - pair.truth.x, 2) + std::pow(moved.y - pair.truth.y, 2);
  }
  return sum;
}

TEST(AlignmentTest, RecoversAnExactSimilarity) {
  const Trajectory truth = testing::random_walk(3, 40);
  Trajectory estimated = truth;
  const Similarity2 known{2.5, {30.0, -4.0, -2.9}};
  for (auto& stamped : estimated) stamped.pose = known * stamped.pose;

  const Similarity2 found = align(pairs_of(estimated, truth), Alignment::kSim2);
  EXPECT_NEAR(found.scale, 1.0 / 2.5, 1e-12);
  EXPECT_NEAR(found.motion.yaw, 2.9, 1e-12);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Pose2 back = found * estimated[i].pose;
    EXPECT_NEAR(back.x, truth[i].pose.x, 1e-9);
    EXPECT_NEAR(back.y, truth[i].pose.y, 1e-9);
    EXPECT_NEAR(wrap_angle(back.yaw - truth[i].pose.yaw), 0.0, 1e-12);
  }
}

// The oracle knows nothing of the closed form: no small step away from the answer may be better.
TEST(AlignmentTest, NoNeighbourOfTheAnswerIsBetter) {
  const Trajectory truth = testing::random_walk(4, 25);
  const auto pairs = pairs_of(testing::with_noise(truth, 9, 1.5, 0.1), truth);
  for (const Alignment kind : {Alignment::kSe2, Alignment::kSim2}) {
    const Similarity2 best = align(pairs, kind);
    const double least = squared_error(pairs, best);
    for (const double step : {-1e-4, 1e-4}) {
      for (int part = 0; part < (kind == Alignment::kSim2 ? 4 : 3); ++part) {
        Similarity2 other = best;
        (part == 0   ? other.motion.x
         : part == 1 ? other.motion.y
         : part == 2 ? other.motion.yaw
                     : other.scale) += step;
        EXPECT_GT(squared_error(pairs, other), least) << to_string(kind) << " " << part;
      }
    }
  }
}

TEST(AlignmentTest, OriginLaysTheFirstPoseOnTheFirstTruth) {
  const Trajectory truth = testing::random_walk(5, 5);
  const auto pairs = pairs_of(testing::with_noise(truth, 1, 2.0, 0.3), truth);
  const Pose2 first = align(pairs, Alignment::kOrigin) * pairs.front().estimated;
  EXPECT_NEAR(first.x, truth.front().pose.x, 1e-9);
  EXPECT_NEAR(first.y, truth.front().pose.y, 1e-9);
  EXPECT_NEAR(wrap_angle(first.yaw - truth.front().pose.yaw), 0.0, 1e-12);
}

TEST(AlignmentTest, NoneIsIdentityAndCoincidingPositionsAreRefused) {
  const Trajectory still = testing::each_second({{1, 2, 0}, {1, 2, 0}, {1, 2, 0}});
  const auto pairs = pairs_of(still, testing::random_walk(1, 3));
  EXPECT_EQ(align(pairs, Alignment::kNone).motion.x, 0.0);
  EXPECT_EQ(align(pairs, Alignment::kNone).scale, 1.0);
  EXPECT_THROW(align(pairs, Alignment::kSe2), Error);
  EXPECT_THROW(align(pairs, Alignment::kSim2), Error);
}

}  // namespace
}  // namespace nadir
