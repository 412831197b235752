// SPDX-License-Identifier: Apache-2.0
// Coarse-to-fine search against the full one, interpolated scores against exact ones.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "map_matching/random_maps.hpp"
#include "nadir/map_matching/coarse_search.hpp"
#include "nadir/map_matching/pose_surfaces.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

using test::centred;
using test::render;
using test::Texture;

Orthomosaic map_of(const Texture& texture) {
  Orthomosaic map = render(texture, 221, 180, {0.0, 18.0, 0.1, {}}, Pose2{});
  test::punch_holes(map, 3, 0.02);
  return map;
}

Orthomosaic local_of(const Texture& texture, const Pose2& pose, int width, int height) {
  Orthomosaic local = render(texture, width, height, centred(width, height, 0.1), pose);
  test::punch_holes(local, 4, 0.2);
  return local;
}

MatchingOptions with(Search search, PoseScoring scoring = PoseScoring::kAuto) {
  MatchingOptions options;
  options.search = search;
  options.pose_scoring = scoring;
  return options;
}

TEST(CoarseToFine, FindsWhatTheFullSearchFinds) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Texture texture(seed + 20);
    const RandomStream random(seed, 5);
    const Pose2 truth{random.uniform(0, 5.0, 17.0), random.uniform(1, 5.0, 13.0),
                      random.uniform(2, -kPi, kPi)};
    const MapIndex coarse(map_of(texture), with(Search::kCoarseToFine));
    const MapIndex full(map_of(texture), with(Search::kFull));
    const Template local = make_template(local_of(texture, truth, 91, 78), coarse.options());
    const SearchRegion everywhere{.yaw_half_range_rad = kPi, .yaw_step_rad = radians(6)};
    const MatchResult quick = match(coarse, local, everywhere);
    const MatchResult slow = match(full, local, everywhere);
    ASSERT_FALSE(quick.candidates.empty());
    ASSERT_FALSE(slow.candidates.empty());
    const Pose2& found = quick.candidates.front().map_from_robot;
    EXPECT_GE(quick.candidates.front().score, slow.candidates.front().score - 1e-3) << seed;
    EXPECT_NEAR(found.x, truth.x, 0.1) << seed;
    EXPECT_NEAR(found.y, truth.y, 0.1) << seed;
    EXPECT_NEAR(wrap_angle(found.yaw - truth.yaw), 0.0, radians(0.5)) << seed;
    EXPECT_LT(quick.volume.score.front().values().size() * 15,
              slow.volume.score.front().values().size());
    for (std::size_t i = 1; i < quick.candidates.size(); ++i) {
      EXPECT_GE(quick.candidates[i - 1].score, quick.candidates[i].score);
    }
  }
}

TEST(CoarseToFine, GivesTheSameForAnyNumberOfThreads) {
  const Texture texture(31);
  const Pose2 truth{9.0, 8.0, 1.0};
  const Template local = make_template(local_of(texture, truth, 80, 80), {});
  std::vector<MatchResult> results;
  for (const std::size_t threads : {1U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const MapIndex map(map_of(texture), with(Search::kCoarseToFine));
    results.push_back(match(map, local, {.yaw_half_range_rad = kPi, .yaw_step_rad = 0.2}));
  }
  ASSERT_EQ(results[0].candidates.size(), results[1].candidates.size());
  for (std::size_t i = 0; i < results[0].candidates.size(); ++i) {
    EXPECT_EQ(results[0].candidates[i].score, results[1].candidates[i].score);
    EXPECT_EQ(results[0].candidates[i].map_from_robot.x, results[1].candidates[i].map_from_robot.x);
    EXPECT_EQ(results[0].candidates[i].map_from_robot.yaw,
              results[1].candidates[i].map_from_robot.yaw);
  }
}

TEST(CoarseToFine, SaysThatThereIsNoOverlapOrNoTexture) {
  const MapIndex map(render(Texture(1), 120, 120, {0.0, 12.0, 0.1, {}}, Pose2{}),
                     with(Search::kCoarseToFine));
  Orthomosaic holes = render(Texture(1), 60, 60, centred(60, 60, 0.1), Pose2{});
  holes.valid = Raster<std::uint8_t>(60, 60);
  EXPECT_EQ(match(map, make_template(holes, map.options()), {.yaw_half_range_rad = kPi}).status,
            MatchStatus::kNoOverlap);
  Orthomosaic flat = render(Texture(1), 60, 60, centred(60, 60, 0.1), Pose2{});
  flat.image = Raster<std::uint8_t>(60, 60, std::uint8_t{90});
  EXPECT_EQ(match(map, make_template(flat, map.options()), {.yaw_half_range_rad = kPi}).status,
            MatchStatus::kNoTexture);
}

TEST(HalvedChannel, AveragesValidPixelsOfOddSizes) {
  ChannelImage channel{Raster<std::uint8_t>(3, 3), Raster<std::uint8_t>(3, 3), {1.0, 2.0, 0.1, {}}};
  for (int i = 0; i < 9; ++i) {
    channel.value.values()[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(10 * i + 10);
    channel.valid.values()[static_cast<std::size_t>(i)] = 1;
  }
  channel.valid.at(0, 0) = 0;
  channel.value.at(0, 0) = 0;
  channel.valid.at(2, 2) = 0;
  channel.value.at(2, 2) = 0;
  const ChannelImage half = halved(channel);
  ASSERT_EQ(half.value.width(), 2);
  ASSERT_EQ(half.value.height(), 2);
  EXPECT_EQ(half.value.at(0, 0), 37);  // of 20, 40, 50
  EXPECT_EQ(half.valid.at(1, 1), 0);
  EXPECT_DOUBLE_EQ(half.geo.resolution, 0.2);
  EXPECT_DOUBLE_EQ(half.geo.west, 1.0);
}

std::vector<Pose2> cloud(const Pose2& around, std::uint64_t count, double half_size, double turn) {
  const RandomStream random(7, 7);
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < count; ++i) {
    poses.push_back({around.x + random.uniform(3 * i, -half_size, half_size),
                     around.y + random.uniform(3 * i + 1, -half_size, half_size),
                     wrap_angle(around.yaw + random.uniform(3 * i + 2, -turn, turn))});
  }
  return poses;
}

TEST(PoseSurfaces, AreCloseToExactScores) {
  const Texture texture(40);
  const Pose2 truth{11.0, 9.0, kPi - 0.01};  // headings on both sides of the turn of the angle
  // Without the factor that a few exact scores give, wncc_paper is 0.019 off.
  for (const auto& [score, limit] :
       {std::pair{Score::kZwncc, 7e-3}, std::pair{Score::kNcc, 2e-3}, std::pair{Score::kWncc, 4e-3},
        std::pair{Score::kWnccPaper, 0.013}}) {
    MatchingOptions options = with(Search::kAuto, PoseScoring::kSurface);
    options.score = score;
    options.paper_weight = PaperWeight::kNormalised;
    const MapIndex map(map_of(texture), options);
    const Template local = make_template(local_of(texture, truth, 61, 90), options);
    const std::vector<Pose2> poses = cloud(truth, 300, 1.0, radians(4));
    ASSERT_TRUE(takes_surfaces(map, local, poses));
    const auto fast = score_poses(map, local, poses);
    const auto exact = backend_of(options).score_poses(map, local, poses);
    double squares = 0.0;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      ASSERT_FALSE(std::isnan(fast[i].score)) << to_string(score) << " " << i;
      squares += (fast[i].score - exact[i].score) * (fast[i].score - exact[i].score);
      // Holes grow by a pixel where the map is sampled, by half of one where the template is.
      ASSERT_NEAR(fast[i].valid_weight, exact[i].valid_weight, 0.1);
    }
    EXPECT_LT(std::sqrt(squares / 300.0), limit) << to_string(score);
  }
}

TEST(PoseSurfaces, ScoreFarAndUndefinedPosesAsExactOnesAre) {
  const Texture texture(41);
  const MapIndex map(map_of(texture), with(Search::kAuto, PoseScoring::kSurface));
  const Template local = make_template(local_of(texture, {10.0, 9.0, 0.2}, 50, 50), map.options());
  std::vector<Pose2> poses = cloud({1.0, 9.0, 0.2}, 200, 2.5, 0.0);  // over the western edge
  poses.push_back({1e300, -1e300, 0.0});
  poses.push_back({1.0, 9.0, std::nan("")});
  const auto fast = score_poses(map, local, poses);
  const auto exact = cpu_backend().score_poses(map, local, poses);
  int undefined = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (std::abs(exact[i].valid_weight - map.options().min_valid_weight) < 0.1) continue;
    EXPECT_EQ(std::isnan(fast[i].score), std::isnan(exact[i].score)) << i;
    undefined += std::isnan(fast[i].score) ? 1 : 0;
  }
  EXPECT_GT(undefined, 10);
}

TEST(PoseSurfaces, AreTakenForManyPosesAndNotForFew) {
  const Texture texture(42);
  const Pose2 truth{10.0, 9.0, 0.0};
  const MapIndex map(map_of(texture), {});
  const Template local = make_template(local_of(texture, truth, 120, 120), {});
  EXPECT_FALSE(takes_surfaces(map, local, cloud(truth, 20, 1.0, 0.02)));
  EXPECT_TRUE(takes_surfaces(map, local, cloud(truth, 20000, 1.0, 0.02)));
  EXPECT_FALSE(takes_surfaces(map, local, {}));
  // So far apart that the surfaces could not be held.
  EXPECT_FALSE(takes_surfaces(map, local, cloud(truth, 20000, 1e6, kPi)));
}

TEST(PoseSurfaces, OneUndisturbedPoseLiesBetweenTheSurfaceAndTheExactScore) {
  const Texture texture(43);
  const MapIndex map(map_of(texture), with(Search::kAuto, PoseScoring::kSurface));
  const Template local = make_template(local_of(texture, {10.0, 9.0, 0.3}, 61, 61), map.options());
  const Pose2 pose{map.channel().geo.x_at(90.5), map.channel().geo.y_at(70.5), 0.3};
  const auto fast = score_poses(map, local, std::span(&pose, 1));
  const RotatedTemplate turned =
      rotate_template(local.channel, 0.3, 0.1, pixel_role(map.options()));
  const double surface =
      reference_backend().score_surfaces(map, std::span(&turned, 1), {90, 70, 1, 1})[0].score.at(0,
                                                                                                 0);
  const double exact = reference_backend().score_poses(map, local, std::span(&pose, 1))[0].score;
  EXPECT_GE(fast[0].score, std::min(surface, exact) - 1e-5);
  EXPECT_LE(fast[0].score, std::max(surface, exact) + 1e-5);
}

}  // namespace
}  // namespace nadir
