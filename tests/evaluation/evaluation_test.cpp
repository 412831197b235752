// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/evaluation.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluation/trajectories.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

using testing::at_second;
using testing::each_second;

/// An estimate that runs east beside a truth on the x axis; `offsets` are its errors in y.
Evaluation evaluate_offsets(const std::vector<double>& offsets) {
  std::vector<Pose2> truth;
  std::vector<Pose2> estimated;
  for (const double offset : offsets) {
    truth.push_back({static_cast<double>(truth.size()), 0.0, 0.0});
    estimated.push_back({truth.back().x, offset, 0.0});
  }
  return evaluate(each_second(estimated), each_second(truth), {});
}

TEST(EvaluationTest, HandWorkedAbsoluteErrors) {
  const Trajectory truth = each_second({{0, 0, 0}, {1, 0, kPi}, {2, 0, 0.5}});
  const Trajectory estimated =
      each_second({{3, 4, 0.1}, {1, 0, -kPi + 0.2}, {2, 0.4, 0.5 - radians(5.0)}});
  const Evaluation e = evaluate(estimated, truth, {});
  EXPECT_NEAR(e.ape_translation_m.max, 5.0, 1e-12);
  EXPECT_NEAR(e.ape_translation_m.mean, 5.4 / 3.0, 1e-12);
  EXPECT_NEAR(e.ape_translation_m.rmse, std::sqrt((25.0 + 0.16) / 3.0), 1e-12);
  // The yaw error of the second frame crosses pi: 0.2, not 2 pi - 0.2.
  EXPECT_NEAR(e.ape_yaw_rad.max, 0.2, 1e-12);
  EXPECT_NEAR(e.errors[2].yaw_rad, -radians(5.0), 1e-12);
  EXPECT_DOUBLE_EQ(e.share_within_half_metre, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(e.share_within_one_metre, 2.0 / 3.0);
}

TEST(EvaluationTest, NothingIsAlignedUnlessAsked) {
  const Trajectory truth = testing::random_walk(8, 30);
  Trajectory shifted = truth;
  for (auto& stamped : shifted) stamped.pose.x += 7.0;
  EXPECT_NEAR(evaluate(shifted, truth, {}).ape_translation_m.mean, 7.0, 1e-9);
  for (const Alignment kind : {Alignment::kOrigin, Alignment::kSe2, Alignment::kSim2}) {
    EXPECT_NEAR(evaluate(shifted, truth, {.alignment = kind}).ape_translation_m.max, 0.0, 1e-9);
  }
}

TEST(EvaluationTest, UnansweredFramesAreCountedAsFailures) {
  const Trajectory truth = testing::random_walk(2, 10);
  Trajectory estimated = truth;
  std::erase_if(estimated, [](const auto& s) { return s.stamp >= at_second(6.0); });
  const Evaluation e = evaluate(estimated, truth, {});
  EXPECT_EQ(e.truth_frames, 10);
  EXPECT_EQ(e.matched_frames, 6);
  EXPECT_EQ(e.unanswered_frames, 4);
  EXPECT_DOUBLE_EQ(e.share_within_half_metre, 0.6);
  EXPECT_DOUBLE_EQ(e.share_within_five_degrees, 0.6);
  EXPECT_EQ(e.ape_translation_m.max, 0.0);
}

TEST(EvaluationTest, StampsMatchUpToTheLimitIncluded) {
  const Trajectory truth = each_second({{0, 0, 0}, {0, 0, 0}});
  Trajectory estimated = truth;
  estimated[0].stamp = at_second(0.010);
  estimated[1].stamp = at_second(1.010000001);
  EXPECT_EQ(evaluate(estimated, truth, {}).matched_frames, 1);
  EXPECT_EQ(evaluate(estimated, truth, {.t_max_diff_s = 0.1}).matched_frames, 2);
}

TEST(EvaluationTest, OneEstimateAnswersForOneInstantOnly) {
  Trajectory truth;
  for (int i = 0; i < 5; ++i) truth.push_back({at_second(0.002 * i), {}});
  const Trajectory estimated{{at_second(0.0041), {}}};
  const Evaluation e = evaluate(estimated, truth, {});
  EXPECT_EQ(e.matched_frames, 1);
  EXPECT_EQ(e.unanswered_frames, 4);
  EXPECT_EQ(e.errors.front().stamp, at_second(0.004));
}

// Association again, in the most obvious way: all pairs of stamps.
TEST(EvaluationTest, AssociationAgreesWithAllPairs) {
  const RandomStream random(11, 0);
  for (std::uint64_t round = 0; round < 50; ++round) {
    Trajectory truth;
    Trajectory estimated;
    double t = 0.0;
    double s = 0.0;
    for (std::uint64_t i = 0; i < 30; ++i) {
      truth.push_back({at_second(t += 0.001 + random.uniform(1000 * round + 2 * i, 0, 0.03)), {}});
      estimated.push_back(
          {at_second(s += 0.001 + random.uniform(1000 * round + 2 * i + 1, 0, 0.03)), {}});
    }
    const auto nearest = [](const Trajectory& in, Stamp stamp) {
      return *std::ranges::min_element(in, {}, [&](const auto& candidate) {
        return std::abs(candidate.stamp.nanoseconds - stamp.nanoseconds);
      });
    };
    int expected = 0;
    for (const auto& stamped : truth) {
      const Stamp answer = nearest(estimated, stamped.stamp).stamp;
      const bool close = std::abs(answer.nanoseconds - stamped.stamp.nanoseconds) <= 10'000'000;
      if (close && nearest(truth, answer).stamp == stamped.stamp) ++expected;
    }
    EXPECT_EQ(evaluate(estimated, truth, {}).matched_frames, expected);
  }
}

TEST(EvaluationTest, RangeOfStampsIncludesBothEnds) {
  const Trajectory truth = testing::random_walk(2, 10);
  const Evaluation e = evaluate(truth, truth, {.first = at_second(2.0), .last = at_second(4.0)});
  EXPECT_EQ(e.truth_frames, 3);
  EXPECT_EQ(e.unanswered_frames, 0);
  EXPECT_THROW(evaluate(truth, truth, {.first = at_second(20.0)}), Error);
}

TEST(EvaluationTest, HandWorkedRelativeErrors) {
  // The estimate makes each step of 1 m 10 % too long and turns 0.1 rad too far in the first.
  const Trajectory truth = each_second({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const Trajectory estimated = each_second(
      {{5, 5, 0}, {6.1, 5, 0.1}, {6.1 + 1.1 * std::cos(0.1), 5 + 1.1 * std::sin(0.1), 0.1}});
  const Evaluation e = evaluate(estimated, truth, {});
  EXPECT_NEAR(e.rpe_translation_m.min, 0.1, 1e-12);
  EXPECT_NEAR(e.rpe_translation_m.max, 0.1, 1e-12);
  EXPECT_NEAR(e.rpe_angle_rad.max, 0.1, 1e-12);
  EXPECT_NEAR(e.rpe_angle_rad.min, 0.0, 1e-12);
}

// Relative errors again with 3x3 matrices, for several deltas in frames.
TEST(EvaluationTest, RelativeErrorsAgreeWithHomogeneousMatrices) {
  const Trajectory truth = testing::random_walk(21, 40);
  const Trajectory estimated = testing::with_noise(truth, 22, 0.3, 0.05);
  const auto matrix = [](const Pose2& p) {
    Eigen::Matrix3d m;
    m << std::cos(p.yaw), -std::sin(p.yaw), p.x, std::sin(p.yaw), std::cos(p.yaw), p.y, 0, 0, 1;
    return m;
  };
  for (const std::size_t delta : {1U, 3U, 7U}) {
    std::vector<double> translation;
    std::vector<double> angle;
    for (std::size_t i = 0; i + delta < truth.size(); i += delta) {
      const Eigen::Matrix3d q = matrix(truth[i].pose).inverse() * matrix(truth[i + delta].pose);
      const Eigen::Matrix3d p =
          matrix(estimated[i].pose).inverse() * matrix(estimated[i + delta].pose);
      const Eigen::Matrix3d d = q.inverse() * p;
      translation.push_back(std::hypot(d(0, 2), d(1, 2)));
      angle.push_back(std::abs(std::atan2(d(1, 0), d(0, 0))));
    }
    const Evaluation e = evaluate(estimated, truth, {.rpe_delta = static_cast<double>(delta)});
    EXPECT_NEAR(e.rpe_translation_m.sse, statistics(translation).sse, 1e-9);
    EXPECT_NEAR(e.rpe_angle_rad.sse, statistics(angle).sse, 1e-9);
  }
}

TEST(EvaluationTest, RelativeErrorsOverMetresOfTruePath) {
  std::vector<Pose2> truth;
  for (int i = 0; i <= 10; ++i) truth.push_back({0.5 * i, 0, 0});
  std::vector<Pose2> estimated = truth;
  for (Pose2& pose : estimated) pose.x *= 1.1;
  const Evaluation e = evaluate(each_second(estimated), each_second(truth),
                                {.rpe_delta = 2.0, .rpe_delta_unit = DeltaUnit::kMetres});
  // Stretches 0-2 m and 2-4 m; the rest is shorter than 2 m.
  EXPECT_NEAR(e.rpe_translation_m.sse, 2 * 0.2 * 0.2, 1e-12);
}

TEST(EvaluationTest, TimeToConvergeIsTheLastEntryBelowOneMetre) {
  EXPECT_EQ(evaluate_offsets({3, 0.5, 3, 0.5, 0.4}).time_to_converge_s, 3.0);
  EXPECT_EQ(evaluate_offsets({0.5, 0.5}).time_to_converge_s, 0.0);
  EXPECT_EQ(evaluate_offsets({0.5, 1.0}).time_to_converge_s, std::nullopt);
}

TEST(EvaluationTest, LostCountsEveryLossAndNeverFoundAsOne) {
  EXPECT_EQ(evaluate_offsets({3, 3, 3}).lost_count, 1);
  EXPECT_EQ(evaluate_offsets({1.5, 1.5}).lost_count, 0);
  EXPECT_EQ(evaluate_offsets({3, 0.5, 3, 3, 1.5, 3, 0.5, 2.0, 2.1}).lost_count, 2);
}

TEST(EvaluationTest, BadInputIsRefused) {
  const Trajectory good = testing::random_walk(1, 4);
  Trajectory not_finite = good;
  not_finite[2].pose.yaw = std::numeric_limits<double>::quiet_NaN();
  Trajectory unsorted = good;
  std::swap(unsorted[1], unsorted[2]);
  Trajectory doubled = good;
  doubled[1].stamp = doubled[0].stamp;
  for (const Trajectory& bad : {Trajectory{}, not_finite, unsorted, doubled}) {
    EXPECT_THROW(evaluate(bad, good, {}), Error);
    EXPECT_THROW(evaluate(good, bad, {}), Error);
  }
  Trajectory other_clock = good;
  for (auto& stamped : other_clock) stamped.stamp.nanoseconds += 1'000'000'000'000;
  EXPECT_THROW(evaluate(other_clock, good, {}), Error);
  EXPECT_THROW(evaluate(good, good, {.t_max_diff_s = -1.0}), Error);
  EXPECT_THROW(evaluate(good, good, {.rpe_delta = 0.0}), Error);
  EXPECT_THROW(evaluate(good, good, {.rpe_delta = 1.5}), Error);
}

}  // namespace
}  // namespace nadir
