// SPDX-License-Identifier: Apache-2.0
// Exact copies must be found again; degenerate input must be called by its name.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <atomic>
#include <cmath>

#include "map_matching/random_maps.hpp"
#include "nadir/core/error.hpp"
#include "nadir/map_matching/matching.hpp"
#include "nadir/map_matching/odometry.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::centred;
using test::render;
using test::Texture;

constexpr int kLocalSize = 80;

Orthomosaic texture_map(const Texture& texture) {
  return render(texture, 260, 200, {0.0, 20.0, 0.1, {}}, Pose2{});
}

Orthomosaic local_map(const Texture& texture, const Pose2& pose) {
  return render(texture, kLocalSize, kLocalSize, centred(kLocalSize, kLocalSize, 0.1), pose);
}

SearchRegion around(const Pose2& pose, double half_size, double yaw_half_range) {
  return {.centre = Point2<frames::Map>{pose.x + 0.3, pose.y - 0.2},
          .half_size_m = half_size,
          .yaw_rad = pose.yaw + 0.01,
          .yaw_half_range_rad = yaw_half_range};
}

/// How far the found pose of a copy may be off, and with which channel.
struct Recovery {
  Channel channel;
  double tolerance_px;
};

class RecoveryTest : public testing::TestWithParam<Recovery> {};

TEST_P(RecoveryTest, FindsAnExactCopyBelowThePixel) {
  const Texture texture(3);
  MatchingOptions options;
  options.channel = GetParam().channel;
  const MapIndex map(texture_map(texture), options);
  const double tolerance = GetParam().tolerance_px * options.resolution_m;
  for (const Pose2& truth : {Pose2{13.0, 10.0, 0.0}, Pose2{12.34, 9.87, 0.7},
                             Pose2{8.02, 12.55, -2.9}, Pose2{17.71, 7.33, kPi}}) {
    const Template local = make_template(local_map(texture, truth), options);
    const MatchResult result = match(map, local, around(truth, 2.0, radians(5)));
    ASSERT_FALSE(result.candidates.empty());
    const Pose2& found = result.candidates.front().map_from_robot;
    EXPECT_NEAR(found.x, truth.x, tolerance);
    EXPECT_NEAR(found.y, truth.y, tolerance);
    EXPECT_NEAR(wrap_angle(found.yaw - truth.yaw), 0.0, radians(0.1));
    EXPECT_GT(result.candidates.front().score, 0.97);
    EXPECT_EQ(result.status, MatchStatus::kOk);
  }
}

// The high-pass knows less of its surroundings at the edge of a small local map than in the map:
// there a copy is not exact.
INSTANTIATE_TEST_SUITE_P(Match, RecoveryTest,
                         testing::Values(Recovery{Channel::kGrey, 0.05},
                                         Recovery{Channel::kHighPass, 0.2}));

TEST(Match, FindsTheCopyWithTheRobotAwayFromTheCentreOfItsLocalMap) {
  const Texture texture(4);
  const MapIndex map(texture_map(texture), {});
  const Pose2 truth{11.2, 9.1, 0.4};
  const GeoReference ahead{1.0, 3.0, 0.1, {}};  // from 1 m to 9 m before the robot
  const Template local =
      make_template(render(texture, kLocalSize, 60, ahead, truth), map.options());
  const MatchResult result = match(map, local, around(truth, 2.0, radians(5)));
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NEAR(result.candidates.front().map_from_robot.x, truth.x, 0.05);
  EXPECT_NEAR(result.candidates.front().map_from_robot.y, truth.y, 0.05);
}

TEST(Match, SearchesTheWholeMapAtEveryHeading) {
  const Texture texture(5);
  MatchingOptions options;
  options.yaw_step_deg = 3.0;
  const MapIndex map(texture_map(texture), options);
  const Pose2 truth{18.0, 11.0, 2.0};
  const Template local = make_template(local_map(texture, truth), options);
  const MatchResult result = match(map, local, {.yaw_half_range_rad = kPi});
  EXPECT_EQ(result.volume.yaws.size(), 120U);
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NEAR(result.candidates.front().map_from_robot.x, truth.x, 0.1);
  EXPECT_NEAR(result.candidates.front().map_from_robot.y, truth.y, 0.1);
  EXPECT_NEAR(wrap_angle(result.candidates.front().map_from_robot.yaw - truth.yaw), 0.0,
              radians(0.5));
}

TEST(Match, PlacesTheCentreAnywhereInTheMapAlsoWhereHalfTheTemplateHangsOut) {
  const Texture texture(6);
  MatchingOptions options;
  options.min_valid_weight = 0.4;
  const MapIndex map(texture_map(texture), options);
  const Pose2 truth{0.1, 10.0, 0.0};  // on the western edge
  const Template local = make_template(local_map(texture, truth), options);
  const MatchResult result = match(map, local, SearchRegion{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NEAR(result.candidates.front().map_from_robot.x, truth.x, 0.06);
  EXPECT_NEAR(result.candidates.front().map_from_robot.y, truth.y, 0.06);
  EXPECT_NEAR(result.candidates.front().valid_weight, 0.5, 0.03);
}

TEST(Match, SurvivesAnotherExposureHolesAndAnotherResolution) {
  const Texture texture(7);
  const MapIndex map(texture_map(texture), {});
  const Pose2 truth{12.0, 9.0, -0.5};
  Orthomosaic local = render(texture, 320, 320, centred(320, 320, 0.025), truth);
  for (std::uint8_t& grey : local.image.values()) grey = static_cast<std::uint8_t>(40 + grey / 2);
  test::punch_holes(local, 1, 0.3);
  const MatchResult result =
      match(map, make_template(local, map.options()), around(truth, 2.0, radians(5)));
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NEAR(result.candidates.front().map_from_robot.x, truth.x, 0.05);
  EXPECT_NEAR(result.candidates.front().map_from_robot.y, truth.y, 0.05);
}

TEST(Match, NamesWhatIsWrong) {
  const Texture texture(8);
  const MapIndex map(texture_map(texture), {});
  Orthomosaic holes = local_map(texture, {12.0, 9.0, 0.0});
  std::fill(holes.valid.values().begin(), holes.valid.values().end(), std::uint8_t{0});
  EXPECT_EQ(match(map, make_template(holes, {}), {}).status, MatchStatus::kNoOverlap);

  Orthomosaic flat = local_map(texture, {12.0, 9.0, 0.0});
  std::fill(flat.image.values().begin(), flat.image.values().end(), std::uint8_t{90});
  EXPECT_EQ(match(map, make_template(flat, {}), {}).status, MatchStatus::kNoTexture);

  const Template far = make_template(local_map(texture, {12.0, 9.0, 0.0}), {});
  const MatchResult outside =
      match(map, far, {.centre = Point2<frames::Map>{500.0, 500.0}, .half_size_m = 1.0});
  EXPECT_EQ(outside.status, MatchStatus::kNoOverlap);
  EXPECT_TRUE(outside.candidates.empty());
  EXPECT_THROW(match(map, far, {.centre = Point2<frames::Map>{NAN, 0.0}}), Error);
}

TEST(Match, AWindowFarBeyondTheMapOverlapsNothing) {
  const Texture texture(9);
  const MapIndex map(texture_map(texture), {});
  const Template local = make_template(local_map(texture, {12.0, 9.0, 0.0}), {});
  for (const double far : {1e9, -1e12, 1e300}) {
    const MatchResult result =
        match(map, local, {.centre = Point2<frames::Map>{far, -far}, .half_size_m = 1.0});
    EXPECT_EQ(result.status, MatchStatus::kNoOverlap) << far;
  }
}

TEST(Match, RefusesScoresThatNoMemoryHolds) {
  const Texture texture(9);
  MatchingOptions options;
  options.search = Search::kFull;
  const MapIndex map(texture_map(texture), options);
  const Template local = make_template(local_map(texture, {12.0, 9.0, 0.0}), options);
  const SearchRegion region{.centre = Point2<frames::Map>{12.0, 9.0}, .half_size_m = 9e3};
  test::expect_error(ErrorKind::kUsage, {"1 headings", "GB of memory", "smaller window"},
                     [&] { match(map, local, region); });
}

TEST(Match, StopsWhereItIsAskedTo) {
  // One thread: with more, how often they ask depends on how they share the work.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Texture texture(9);
  MatchingOptions options;
  for (const Search search : {Search::kFull, Search::kCoarseToFine}) {
    options.search = search;
    const MapIndex map(texture_map(texture), options);
    const Template local = make_template(local_map(texture, {12.0, 9.0, 0.0}), options);
    const SearchRegion region{.yaw_half_range_rad = kPi};
    std::atomic<int> asked{0};
    const MatchResult whole = match(map, local, region, StopToken([&] {
                                      ++asked;
                                      return false;
                                    }));
    EXPECT_FALSE(whole.candidates.empty());
    EXPECT_GT(asked, 20);
    for (const int after : {0, asked / 4, asked / 2, asked - 8}) {
      std::atomic<int> left{after};
      EXPECT_THROW(match(map, local, region, StopToken([&] { return left-- <= 0; })), Stopped)
          << after << " of " << asked;
    }
  }
}

TEST(Match, TakesATemplateLargerThanTheMap) {
  const Texture texture(9);
  MatchingOptions options;
  options.min_valid_weight = 0.1;
  const MapIndex map(render(texture, 50, 40, {0.0, 4.0, 0.1, {}}, Pose2{}), options);
  const Pose2 truth{2.5, 2.0, 0.0};
  const MatchResult result =
      match(map, make_template(local_map(texture, truth), options), SearchRegion{});
  ASSERT_FALSE(result.candidates.empty());
  EXPECT_NEAR(result.candidates.front().map_from_robot.x, truth.x, 0.06);
  EXPECT_NEAR(result.candidates.front().map_from_robot.y, truth.y, 0.06);
}

TEST(Match, CallsARepeatedPlaceAmbiguous) {
  // Two equal halves.
  const Texture texture(10);
  Orthomosaic map = texture_map(texture);
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < 130; ++column) {
      map.image.at(130 + column, row) = map.image.at(column, row);
    }
  }
  const MapIndex index(map, {});
  const Template local = make_template(local_map(texture, {6.0, 10.0, 0.0}), {});
  const MatchResult result = match(index, local, {});
  EXPECT_EQ(result.status, MatchStatus::kAmbiguous);
  ASSERT_GE(result.candidates.size(), 2U);
  EXPECT_NEAR(
      std::abs(result.candidates[0].map_from_robot.x - result.candidates[1].map_from_robot.x), 13.0,
      0.05);
}

TEST(Match, SameBytesForAnyNumberOfThreads) {
  const Texture texture(11);
  const MapIndex map(texture_map(texture), {});
  const Pose2 truth{12.0, 9.0, -0.5};
  const Template local = make_template(local_map(texture, truth), {});
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return match(map, local, around(truth, 1.0, radians(3)));
  };
  const MatchResult one = run(1);
  const MatchResult many = run(4);
  ASSERT_EQ(one.volume.score.size(), many.volume.score.size());
  for (std::size_t k = 0; k < one.volume.score.size(); ++k) {
    for (std::size_t i = 0; i < one.volume.score[k].values().size(); ++i) {
      const float a = one.volume.score[k].values()[i];
      const float b = many.volume.score[k].values()[i];
      ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b)));
    }
  }
}

TEST(MakeTemplate, RefusesWhatIsNoLocalMap) {
  EXPECT_THROW(make_template(Orthomosaic{}, {}), Error);
  Orthomosaic image = test::random_image(1, 10, 10, 0.0, {});
  image.valid = Raster<std::uint8_t>(9, 10);
  EXPECT_THROW(make_template(image, {}), Error);
  EXPECT_THROW(MapIndex(test::random_image(1, 10, 10, 1.1, {}), {}), Error);
}

TEST(RegisterLocalMaps, FindsTheMotion) {
  const Texture texture(12);
  const Pose2 first{12.0, 9.0, 0.3};
  const Motion2 truth{0.52, -0.17, radians(2)};
  RegistrationOptions options;
  options.max_turn_deg = 4.0;
  const auto motion =
      register_local_maps(local_map(texture, first), local_map(texture, first * truth), options);
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->x, truth.x, 0.05);
  EXPECT_NEAR(motion->y, truth.y, 0.05);
  EXPECT_NEAR(motion->yaw, truth.yaw, radians(0.2));
}

TEST(RegisterLocalMaps, LooksFartherWhenFramesAreMissing) {
  const Texture texture(13);
  const Pose2 first{12.0, 9.0, 0.0};
  const Motion2 truth{3.1, 0.4, 0.0};  // beyond max_step_m
  const auto motion =
      register_local_maps(local_map(texture, first), local_map(texture, first * truth), {});
  ASSERT_TRUE(motion);
  EXPECT_NEAR(motion->x, truth.x, 0.05);
}

TEST(RegisterLocalMaps, DoesNotInventAMotion) {
  const Texture texture(14);
  const Texture elsewhere(15);
  EXPECT_FALSE(register_local_maps(local_map(texture, {12.0, 9.0, 0.0}),
                                   local_map(elsewhere, {12.0, 9.0, 0.0}), {}));
}

}  // namespace
}  // namespace nadir
