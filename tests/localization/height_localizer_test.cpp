// SPDX-License-Identifier: Apache-2.0
// Colour and heights together, on a street whose colours and heights are known at every point.
#include <gtest/gtest.h>

#include <cmath>

#include "localization/textured_drive.hpp"
#include "map_matching/height_fields.hpp"
#include "map_matching/random_maps.hpp"
#include "nadir/localizer.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::centred;
using test::kFrames;
using test::kMapGeo;
using test::kTexture;
using test::map_image;
using test::Street;
using test::truth_at;

constexpr int kSide = 100;

ElevationMap surface() { return test::heights_of(Street(5, 0.03, 41.0), 300, 200, kMapGeo, {}); }

/// A drive whose odometry falls short by 6 %.
std::vector<Frame> drive(bool with_colour, bool with_heights) {
  std::vector<Frame> frames;
  OdomPose2 odom;
  const GeoReference geo = centred(kSide, kSide, 0.1);
  for (int k = 0; k < kFrames; ++k) {
    if (k > 0) {
      const Motion2 motion = truth_at(k - 1).inverse() * truth_at(k);
      odom = odom * Motion2{0.94 * motion.x, 0.94 * motion.y, motion.yaw};
    }
    const auto seed = static_cast<std::uint64_t>(k);
    Frame frame{{k * std::int64_t{1'000'000'000}},
                test::render(kTexture, kSide, kSide, geo, truth_at(k)),
                odom};
    test::punch_holes(frame.local, seed, with_colour ? 0.3 : 1.1);
    if (with_heights) {
      frame.elevation = test::heights_of(Street(5, 0.0, -0.4), kSide, kSide, geo, truth_at(k));
      test::degrade(*frame.elevation, seed, 0.03, 0.3);
    }
    frames.push_back(std::move(frame));
  }
  return frames;
}

std::vector<Estimate> run(Layers layers, const std::optional<ElevationMap>& heights,
                          const std::vector<Frame>& frames) {
  LocalizerOptions options;
  options.matching.layers = layers;
  options.localization.start_particles = 4000;
  Localizer localizer(map_image(), heights, options, 1);
  localizer.start_near(truth_at(0), {2.0, radians(5)});
  std::vector<Estimate> estimates;
  for (const Frame& frame : frames) estimates.push_back(localizer.update(frame));
  return estimates;
}

double largest_error(const std::vector<Estimate>& estimates, int from) {
  double largest = 0.0;
  for (int k = from; k < kFrames; ++k) {
    const Pose2& pose = estimates[static_cast<std::size_t>(k)].map_from_robot;
    largest = std::max(largest, std::hypot(pose.x - truth_at(k).x, pose.y - truth_at(k).y));
  }
  return largest;
}

void expect_same(const std::vector<Estimate>& a, const std::vector<Estimate>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].map_from_robot.x, b[k].map_from_robot.x);
    EXPECT_EQ(a[k].map_from_robot.y, b[k].map_from_robot.y);
    EXPECT_EQ(a[k].map_from_robot.yaw, b[k].map_from_robot.yaw);
    EXPECT_EQ(a[k].covariance, b[k].covariance);
    EXPECT_EQ(a[k].best_score, b[k].best_score);
    EXPECT_EQ(a[k].status, b[k].status);
  }
}

TEST(HeightLocalizer, HeightsAloneFollowADrive) {
  EXPECT_LT(largest_error(run(Layers::kHeight, surface(), drive(true, true)), 3), 0.2);
}

TEST(HeightLocalizer, HeightsStandInWhereThereIsNothingToSee) {
  const std::vector<Frame> frames = drive(false, true);
  const std::vector<Estimate> estimates = run(Layers::kBoth, surface(), frames);
  EXPECT_LT(largest_error(estimates, 3), 0.2);
  for (const Estimate& estimate : estimates) EXPECT_EQ(estimate.status, EstimateStatus::kOk);
  EXPECT_NE(run(Layers::kColour, surface(), frames).back().status, EstimateStatus::kOk);
}

TEST(HeightLocalizer, ASurfaceOfAnotherPlaceIsNoticed) {
  ElevationMap shifted = surface();
  shifted.geo.west += 0.7;
  EXPECT_GT(largest_error(run(Layers::kHeight, shifted, drive(true, true)), 3), 0.5);
}

TEST(HeightLocalizer, BothAreAsGoodAsTheBetter) {
  EXPECT_LT(largest_error(run(Layers::kBoth, surface(), drive(true, true)), 2), 0.1);
}

TEST(HeightLocalizer, WithoutHeightsNothingChangesByASurface) {
  const std::vector<Frame> frames = drive(true, false);
  const std::vector<Estimate> colour = run(Layers::kColour, std::nullopt, frames);
  expect_same(colour, run(Layers::kBoth, surface(), frames));
  expect_same(colour, run(Layers::kBoth, std::nullopt, drive(true, true)));
  expect_same(colour, run(Layers::kColour, surface(), drive(true, true)));
}

TEST(HeightLocalizer, FramesWithoutHeightsAreCarriedByColour) {
  std::vector<Frame> frames = drive(true, true);
  for (std::size_t k = 4; k < 8; ++k) frames[k].elevation.reset();
  EXPECT_LT(largest_error(run(Layers::kBoth, surface(), frames), 2), 0.1);
  const std::vector<Estimate> heights = run(Layers::kHeight, surface(), frames);
  EXPECT_EQ(heights[5].status, EstimateStatus::kNoTexture);
  EXPECT_GT(heights[7].covariance.trace(), heights[3].covariance.trace());
  EXPECT_EQ(heights[9].status, EstimateStatus::kOk);
}

TEST(HeightLocalizer, HeightsAloneNeedASurface) {
  test::expect_error(ErrorKind::kUsage, {"no surface", "map_matching.layers"},
                     [] { run(Layers::kHeight, std::nullopt, {}); });
}

}  // namespace
}  // namespace nadir
