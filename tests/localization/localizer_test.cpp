// SPDX-License-Identifier: Apache-2.0
// The composition root, on a texture that is known exactly at every point.
#include "nadir/localizer.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "localization/textured_drive.hpp"
#include "map_matching/random_maps.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

using test::centred;
using test::kFrames;
using test::kTexture;
using test::map_image;
using test::render;
using test::Texture;
using test::truth_at;

/// A drive whose odometry falls short by 6 %.
std::vector<Frame> drive(bool with_odometry) {
  std::vector<Frame> frames;
  OdomPose2 odom;
  for (int k = 0; k < kFrames; ++k) {
    if (k > 0) {
      const Motion2 motion = truth_at(k - 1).inverse() * truth_at(k);
      odom = odom * Motion2{0.94 * motion.x, 0.94 * motion.y, motion.yaw};
    }
    Frame frame{{k * std::int64_t{1'000'000'000}},
                render(kTexture, 80, 80, centred(80, 80, 0.1), truth_at(k)),
                {}};
    test::punch_holes(frame.local, static_cast<std::uint64_t>(k), 0.3);
    if (with_odometry) frame.odom_from_robot = odom;
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<Estimate> run(const LocalizerOptions& options, const std::vector<Frame>& frames,
                          std::uint64_t seed = 1, const Pose2& prior = truth_at(0)) {
  Localizer localizer(map_image(), options, seed);
  localizer.start_near(prior, {2.0, radians(5)});
  std::vector<Estimate> estimates;
  for (const Frame& frame : frames) estimates.push_back(localizer.update(frame));
  return estimates;
}

double error(const Estimate& estimate, int frame) {
  return std::hypot(estimate.map_from_robot.x - truth_at(frame).x,
                    estimate.map_from_robot.y - truth_at(frame).y);
}

TEST(Localizer, FollowsADriveWithOdometry) {
  const std::vector<Estimate> estimates = run({}, drive(true));
  for (int k = 2; k < kFrames; ++k) {
    const Estimate& estimate = estimates[static_cast<std::size_t>(k)];
    EXPECT_LT(error(estimate, k), 0.1) << k;
    EXPECT_NEAR(wrap_angle(estimate.map_from_robot.yaw - truth_at(k).yaw), 0.0, radians(1)) << k;
    EXPECT_EQ(estimate.status, EstimateStatus::kOk);
  }
}

TEST(Localizer, FollowsADriveByItsLocalMapsAlone) {
  LocalizerOptions options;
  options.registration.max_turn_deg = 3.0;
  const std::vector<Estimate> estimates = run(options, drive(false));
  for (int k = 2; k < kFrames; ++k) {
    EXPECT_LT(error(estimates[static_cast<std::size_t>(k)], k), 0.1) << k;
  }
}

TEST(Localizer, AFrameThatShowsNothingIsPredictedAndItsDoubtGrows) {
  std::vector<Frame> frames = drive(true);
  for (std::size_t k = 6; k < 9; ++k) {
    auto& valid = frames[k].local.valid.values();
    std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  }
  const std::vector<Estimate> estimates = run({}, frames);
  EXPECT_EQ(estimates[6].status, EstimateStatus::kNoOverlap);
  EXPECT_TRUE(std::isnan(estimates[6].best_score));
  EXPECT_GT(estimates[8].covariance.trace(), estimates[5].covariance.trace());
  EXPECT_LT(error(estimates[8], 8), 0.3);
  EXPECT_EQ(estimates[9].status, EstimateStatus::kOk);
  EXPECT_LT(error(estimates[10], 10), 0.1);
}

TEST(Localizer, AnAllHoleFrameStopsNothingWithoutOdometryEither) {
  std::vector<Frame> frames = drive(false);
  auto& valid = frames[5].local.valid.values();
  std::fill(valid.begin(), valid.end(), std::uint8_t{0});
  const std::vector<Estimate> estimates = run({}, frames);
  EXPECT_NE(estimates[5].status, EstimateStatus::kOk);
  EXPECT_EQ(estimates[6].status, EstimateStatus::kNoOdometry);
  EXPECT_LT(error(estimates[11], 11), 0.2);
}

// Authors' fault "map crop centred on the truth, so that the filter cannot get lost".
TEST(Localizer, AWrongPriorIsNotPulledToTheTruthByMagic) {
  const Pose2 elsewhere{truth_at(0).x + 9.0, truth_at(0).y, truth_at(0).yaw};
  const std::vector<Estimate> estimates = run({}, drive(true), 1, elsewhere);
  EXPECT_GT(error(estimates[0], 0), 5.0);
}

TEST(Localizer, SaysWhenItIsOutsideTheMap) {
  const Pose2 outside{-50.0, -50.0, 0.0};
  const std::vector<Estimate> estimates = run({}, drive(true), 1, outside);
  for (const Estimate& estimate : estimates) {
    EXPECT_EQ(estimate.status, EstimateStatus::kNoOverlap);
    EXPECT_TRUE(estimate.map_from_robot.is_finite());
    EXPECT_TRUE(estimate.covariance.allFinite());
  }
}

TEST(Localizer, SaysWhenThereIsNoOdometry) {
  std::vector<Frame> frames = drive(false);
  // The fifth local map is of another place: it cannot be registered.
  frames[4].local = render(Texture(99), 80, 80, centred(80, 80, 0.1), truth_at(4));
  EXPECT_EQ(run({}, frames)[4].status, EstimateStatus::kNoOdometry);
}

TEST(Localizer, SameBytesForAnyNumberOfThreads) {
  const std::vector<Frame> frames = drive(false);
  const auto with_threads = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return run({}, frames);
  };
  const auto one = with_threads(1);
  const auto four = with_threads(4);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_EQ(one[k].map_from_robot.x, four[k].map_from_robot.x);
    EXPECT_EQ(one[k].map_from_robot.yaw, four[k].map_from_robot.yaw);
    EXPECT_EQ(one[k].covariance, four[k].covariance);
  }
}

TEST(Localizer, GoesOnInANewerVersionOfTheMap) {
  // At first the map ends at x = 12: the robot drives off it. Then its rest is there, on a grid
  // that begins farther south-west.
  const Orthomosaic first = render(kTexture, 120, 200, {0.0, 20.0, 0.1, {}}, Pose2{});
  const Orthomosaic second = render(kTexture, 350, 250, {-5.0, 22.0, 0.1, {}}, Pose2{});
  Localizer localizer(first, {}, 1);
  localizer.start_near(truth_at(0), {2.0, radians(5)});
  const std::vector<Frame> frames = drive(true);
  for (int k = 0; k < kFrames; ++k) {
    const Estimate estimate = localizer.update(frames[static_cast<std::size_t>(k)]);
    if (k >= 2) {
      EXPECT_LT(error(estimate, k), 0.1) << k;
    }
    if (k == 4) localizer.use_map(second);
  }
  Orthomosaic coarse = second;
  coarse.geo.resolution = 0.2;
  EXPECT_THROW(localizer.use_map(coarse), Error);
  Orthomosaic elsewhere = second;
  elsewhere.geo.crs = "another";
  EXPECT_THROW(localizer.use_map(elsewhere), Error);
}

void expect_same(const Estimate& a, const Estimate& b) {
  EXPECT_EQ(a.map_from_robot.x, b.map_from_robot.x);
  EXPECT_EQ(a.map_from_robot.y, b.map_from_robot.y);
  EXPECT_EQ(a.map_from_robot.yaw, b.map_from_robot.yaw);
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.effective_particles, b.effective_particles);
  EXPECT_EQ(a.resampled, b.resampled);
  EXPECT_EQ(a.status, b.status);
}

TEST(Localizer, AFrameThatThrowsChangesNothingAndMayBeGivenAgain) {
  const std::vector<Frame> frames = drive(true);
  const std::vector<Estimate> undisturbed = run({}, frames);
  Localizer localizer(map_image(), {}, 1);
  localizer.start_near(truth_at(0), {2.0, radians(5)});
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const ParticleSet before = localizer.particles();
    Frame damaged = frames[k];
    damaged.local.valid = Raster<std::uint8_t>{3, 3, 255};  // a mask of another size
    for (int attempt = 0; attempt < 2; ++attempt) {
      EXPECT_THROW(localizer.update(damaged), Error);
      EXPECT_EQ(localizer.particles().weights, before.weights);
      ASSERT_EQ(localizer.particles().poses.size(), before.poses.size());
      EXPECT_EQ(localizer.particles().poses.front().x, before.poses.front().x);
    }
    expect_same(localizer.update(frames[k]), undisturbed[k]);
  }
}

TEST(Localizer, AMapThatThrowsLeavesTheOneBefore) {
  const std::vector<Frame> frames = drive(true);
  const std::vector<Estimate> undisturbed = run({}, frames);
  Localizer localizer(map_image(), {}, 1);
  localizer.start_near(truth_at(0), {2.0, radians(5)});
  Orthomosaic all_holes = map_image();
  std::ranges::fill(all_holes.valid.values(), std::uint8_t{0});
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (k == 4) {
      EXPECT_THROW(localizer.use_map(all_holes), Error);
    }
    expect_same(localizer.update(frames[k]), undisturbed[k]);
  }
}

TEST(Localizer, ThePaperPresetRuns) {
  LocalizerOptions options = LocalizerOptions::paper();
  for (const Score score : {Score::kNcc, Score::kWncc, Score::kWnccPaper}) {
    options.matching.score = score;
    const std::vector<Estimate> estimates = run(options, drive(true));
    EXPECT_FALSE(estimates.front().resampled);
    for (std::size_t k = 1; k < estimates.size(); ++k) {
      EXPECT_TRUE(estimates[k].map_from_robot.is_finite());
      EXPECT_TRUE(estimates[k].resampled);
    }
  }
}

TEST(Localizer, RefusesWhatItCannotUse) {
  Localizer localizer(map_image(), {}, 1);
  std::vector<Frame> frames = drive(true);
  EXPECT_THROW(localizer.update(frames[0]), Error);  // not started
  localizer.start_near(truth_at(0), {});
  localizer.update(frames[0]);
  EXPECT_THROW(localizer.update(frames[0]), Error);  // the same stamp again
  frames[1].odom_from_robot = OdomPose2{NAN, 0.0, 0.0};
  EXPECT_THROW(localizer.update(frames[1]), Error);
  LocalizerOptions linear = LocalizerOptions::paper();
  linear.matching.score = Score::kSsd;
  EXPECT_THROW(Localizer(map_image(), linear, 1), Error);
}

}  // namespace
}  // namespace nadir
