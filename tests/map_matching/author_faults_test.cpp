// SPDX-License-Identifier: Apache-2.0
// One test for each fault of matching that was found in the paper's authors' scripts. Those of
// their filter stand in tests/localization/author_faults_test.cpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "map_matching/random_maps.hpp"
#include "nadir/map_matching/rotated_template.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

using test::centred;
using test::render;
using test::Texture;

const Texture kTexture(21);
constexpr int kSmallLocalSize = 60;

Orthomosaic map_image() { return render(kTexture, 240, 130, {0.0, 13.0, 0.1, {}}, Pose2{}); }

Orthomosaic local_image(const Pose2& pose, int width = kSmallLocalSize,
                        int height = kSmallLocalSize) {
  return render(kTexture, width, height, centred(width, height, 0.1), pose);
}

MatchingOptions with(Score score) {
  MatchingOptions options;
  options.score = score;
  options.channel = Channel::kGrey;
  return options;
}

double score_at(const Pose2& pose, const Orthomosaic& local, const MatchingOptions& options) {
  const MapIndex map(map_image(), options);
  const Pose2 poses[] = {pose};
  return score_poses(map, make_template(local, options), poses).front().score;
}

TEST(AuthorFaults, CosineTakenForNcc) {
  // A brighter exposure changes the cosine, but must not change the correlation.
  const Pose2 pose{12.0, 6.5, 0.2};
  Orthomosaic brighter = local_image(pose);
  for (std::uint8_t& grey : brighter.image.values())
    grey = static_cast<std::uint8_t>(grey / 2 + 100);
  for (const Score score : {Score::kZncc, Score::kZwncc}) {
    EXPECT_GT(score_at(pose, brighter, with(score)), 0.99);
  }
  EXPECT_LT(score_at(pose, brighter, with(Score::kNcc)), 0.985);
}

TEST(AuthorFaults, MaskThatDropsExactlyTheMatchingPixels) {
  // Every pixel equal: a perfect match is the best score (to the rounding of single precision, in
  // grey levels), not NaN.
  const Pose2 pose{12.0, 6.5, 0.0};  // pixels on pixels
  for (const Score score : {Score::kSsd, Score::kSad}) {
    EXPECT_NEAR(score_at(pose, local_image(pose), with(score)), 0.0, 0.01) << to_string(score);
  }
  for (const Score score : {Score::kNcc, Score::kZncc, Score::kZwncc}) {
    EXPECT_GT(score_at(pose, local_image(pose), with(score)), 0.998) << to_string(score);
  }
}

TEST(AuthorFaults, RotationThatFillsWithZeroes) {
  const MatchingOptions options = with(Score::kZwncc);
  const Template local = make_template(local_image({12.0, 6.5, 0.0}), options);
  const RotatedTemplate turned =
      rotate_template(local.channel, radians(45), 0.1, pixel_role(options));
  double used = 0.0;
  for (std::size_t i = 0; i < turned.mask.values().size(); ++i) {
    used += turned.mask.values()[i];
    if (turned.mask.values()[i] != 0.0F) {
      EXPECT_GE(turned.value.values()[i], 20.0F);
    }
  }
  EXPECT_EQ(turned.mask.at(0, 0), 0.0F);  // a corner of the bounding box is no pixel
  EXPECT_NEAR(used, kSmallLocalSize * kSmallLocalSize, 0.02 * kSmallLocalSize * kSmallLocalSize);
}

TEST(AuthorFaults, NoMinimumOverlap) {
  // A sliver at the map's edge can correlate perfectly by chance; it is no match.
  const MatchingOptions options = with(Score::kZwncc);
  const MapIndex map(map_image(), options);
  const Pose2 poses[] = {{-2.8, 6.5, 0.0}};
  const PoseScore sliver =
      score_poses(map, make_template(local_image(poses[0]), options), poses).front();
  EXPECT_TRUE(std::isnan(sliver.score));
  EXPECT_LT(sliver.valid_weight, 0.1);
}

TEST(AuthorFaults, WindowOffsetAppliedTwice) {
  const MapIndex map(map_image(), {});
  const Pose2 truth{15.03, 8.02, 0.0};
  const Template local = make_template(local_image(truth), {});
  const Pose2 whole = match(map, local, {}).candidates.at(0).map_from_robot;
  const Pose2 window =
      match(map, local, {.centre = Point2<frames::Map>{14.2, 7.7}, .half_size_m = 2.0})
          .candidates.at(0)
          .map_from_robot;
  EXPECT_NEAR(whole.x, window.x, 1e-3);
  EXPECT_NEAR(whole.y, window.y, 1e-3);
  EXPECT_NEAR(whole.x, truth.x, 0.05);
}

TEST(AuthorFaults, RowsAndColumnsSwapped) {
  // Neither the map nor the local map is square, and the place is far from the diagonal.
  const MapIndex map(map_image(), {});
  const Pose2 truth{20.0, 3.0, 0.0};
  const Template local = make_template(local_image(truth, 60, 34), {});
  const Pose2 found = match(map, local, {}).candidates.at(0).map_from_robot;
  EXPECT_NEAR(found.x, truth.x, 0.05);
  EXPECT_NEAR(found.y, truth.y, 0.05);
}

TEST(AuthorFaults, CropClampedAtTheBorderWithoutMovingItsOrigin) {
  // The search window hangs out of the map on the north-west.
  MatchingOptions options;
  options.min_valid_weight = 0.3;
  const MapIndex map(map_image(), options);
  const Pose2 truth{0.6, 12.2, 0.0};
  const Template local = make_template(local_image(truth), options);
  const MatchResult result =
      match(map, local, {.centre = Point2<frames::Map>{0.5, 12.5}, .half_size_m = 3.0});
  EXPECT_NEAR(result.candidates.at(0).map_from_robot.x, truth.x, 0.06);
  EXPECT_NEAR(result.candidates.at(0).map_from_robot.y, truth.y, 0.06);
}

TEST(AuthorFaults, DegreesTakenForRadians) {
  // A heading of 30 degrees is found as 30 degrees, counter-clockwise from east.
  const MapIndex map(map_image(), {});
  const Pose2 truth{12.0, 6.5, radians(30)};
  const MatchResult result = match(map, make_template(local_image(truth), {}),
                                   {.centre = Point2<frames::Map>{12.0, 6.5},
                                    .half_size_m = 0.5,
                                    .yaw_rad = radians(28),
                                    .yaw_half_range_rad = radians(5)});
  EXPECT_NEAR(degrees(result.candidates.at(0).map_from_robot.yaw), 30.0, 0.1);
}

TEST(AuthorFaults, HolesTakenForWhitePixelsPreferHoles) {
  // The failure that the paper shows in Fig. 6: with holes as white pixels, a wrong place that has
  // holes of its own beats the right one; masked, it does not.
  Orthomosaic map = map_image();
  for (int row = 30; row < 100; ++row) {
    for (int column = 150; column < 220; ++column) map.valid.at(column, row) = 0;
  }
  const Pose2 truth{6.05, 6.45, 0.0};
  Orthomosaic local = local_image(truth);
  test::punch_holes(local, 5, 0.6);
  MatchingOptions options = with(Score::kSsd);
  options.min_valid_weight = 0.01;
  const auto error = [&](HoleTreatment holes) {
    options.holes = holes;
    const Pose2 found = match(MapIndex(map, options), make_template(local, options), {})
                            .candidates.at(0)
                            .map_from_robot;
    return std::hypot(found.x - truth.x, found.y - truth.y);
  };
  EXPECT_LT(error(HoleTreatment::kMasked), 0.1);
  EXPECT_GT(error(HoleTreatment::kWhite), 3.0);
}

}  // namespace
}  // namespace nadir
