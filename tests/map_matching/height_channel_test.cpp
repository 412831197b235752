// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/height_channel.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "map_matching/height_fields.hpp"
#include "map_matching/random_maps.hpp"
#include "support/expect_error.hpp"

namespace nadir {
namespace {

using test::centred;
using test::degrade;
using test::heights_of;
using test::Street;

constexpr int kSide = 180;
constexpr int kGround = 128;
const GeoReference kMapGeo{0.0, 20.0, 0.1, {}};

ElevationMap plane(double east, double north, double datum) {
  ElevationMap heights{Raster<float>(kSide, kSide), centred(kSide, kSide, 0.1)};
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      heights.height_m.at(column, row) = static_cast<float>(
          datum + east * heights.geo.x_at(column + 0.5) + north * heights.geo.y_at(row + 0.5));
    }
  }
  return heights;
}

int largest_difference(const ChannelImage& a, const ChannelImage& b) {
  int largest = 0;
  for (std::size_t i = 0; i < a.value.values().size(); ++i) {
    largest = std::max(largest, std::abs(a.value.values()[i] - b.value.values()[i]));
  }
  return largest;
}

TEST(HeightChannel, ASlopeIsGroundUpToItsBorders) {
  const ChannelImage channel = make_height_channel(plane(0.08, -0.05, 512.0), {}, "it");
  for (const std::uint8_t value : channel.value.values()) ASSERT_NEAR(value, kGround, 1);
}

TEST(HeightChannel, ASlopeIsGroundAroundHoles) {
  ElevationMap heights = plane(0.08, -0.05, 512.0);
  degrade(heights, 1, 0.0, 0.4);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 100; column < 150; ++column) heights.height_m.at(column, row) = NAN;
  }
  const ChannelImage channel = make_height_channel(heights, {}, "it");
  for (std::size_t i = 0; i < channel.value.values().size(); ++i) {
    ASSERT_EQ(channel.valid.values()[i] != 0, std::isfinite(heights.height_m.values()[i]));
    ASSERT_NEAR(channel.value.values()[i], channel.valid.values()[i] != 0 ? kGround : 0, 1);
  }
}

TEST(HeightChannel, NeitherDatumNorSlopeMatters) {
  const auto channel_of = [](const Street& street) {
    return make_height_channel(heights_of(street, kSide, kSide, kMapGeo, {}), {}, "it");
  };
  const ChannelImage level = channel_of(Street(3, 0.0, 0.0));
  EXPECT_LE(largest_difference(level, channel_of(Street(3, 0.0, 512.0))), 1);
  EXPECT_LE(largest_difference(level, channel_of(Street(3, 0.05, 0.0))), 6);
}

TEST(HeightChannel, AHouseDoesNotLiftTheGroundBesideIt) {
  ElevationMap heights = plane(0.0, 0.0, 0.0);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 130; column < kSide; ++column) heights.height_m.at(column, row) = 8.0F;
  }
  const ChannelImage channel = make_height_channel(heights, {}, "it");
  EXPECT_NEAR(channel.value.at(129, 90), kGround, 12);
  EXPECT_NEAR(channel.value.at(100, 90), kGround, 3);
  EXPECT_EQ(channel.valid.at(131, 90), 0) << "what stands above the ceiling is unknown";
}

TEST(HeightChannel, AKerbIsSeenAndAHedgeIsNotSeenNineTimesAsMuch) {
  ElevationMap heights = plane(0.0, 0.0, 0.0);
  for (int row = 0; row < kSide; ++row) {
    for (int column = 90; column < kSide; ++column) heights.height_m.at(column, row) = 0.12F;
    for (int column = 95; column < 98; ++column) heights.height_m.at(column, row) = 1.1F;
  }
  const ChannelImage channel = make_height_channel(heights, {}, "it");
  const int kerb = channel.value.at(91, 90) - channel.value.at(88, 90);
  const int wall = channel.value.at(96, 90) - channel.value.at(88, 90);
  EXPECT_GT(kerb, 25);
  EXPECT_NE(channel.valid.at(96, 90), 0);
  EXPECT_GT(wall, 2 * kerb);
  EXPECT_LT(wall, 5 * kerb);
}

TEST(HeightChannel, RefusesWhatHasNoPixelsAndAMapWithoutHeights) {
  test::expect_error(ErrorKind::kInput, {"the surface"},
                     [] { make_height_channel({}, {}, "the surface"); });
  const ElevationMap unknown = plane(0.0, 0.0, NAN);
  test::expect_error(ErrorKind::kInput, {"no valid pixel"},
                     [&] { MapIndex(unknown, MatchingOptions{}); });
}

class HeightMatchTest : public testing::TestWithParam<Backend> {};

TEST_P(HeightMatchTest, FindsThePlaceAcrossDatumSlopeNoiseAndHoles) {
  MatchingOptions options;
  options.backend = GetParam();
  const bool slow = options.backend == Backend::kReference;
  options.resolution_m = slow ? 0.2 : 0.1;
  const MapIndex map(heights_of(Street(5, 0.03, 41.0), 500, 200, kMapGeo, {}), options);
  const Pose2 truth{24.3, 9.2, 0.1};
  ElevationMap local =
      heights_of(Street(5, 0.0, -0.4), kSide, kSide, centred(kSide, kSide, 0.1), truth);
  degrade(local, 2, 0.03, 0.3);
  SearchRegion region;
  region.centre = Point2<frames::Map>{25.4, 8.1};
  region.half_size_m = 2.0;
  region.yaw_rad = 0.1 + radians(slow ? 0.0 : 1.3);
  region.yaw_half_range_rad = radians(slow ? 0.0 : 3.0);
  const MatchResult result = match(map, make_template(local, options), region);
  ASSERT_FALSE(result.candidates.empty());
  const Pose2& found = result.candidates.front().map_from_robot;
  EXPECT_NEAR(found.x, truth.x, 0.06);
  EXPECT_NEAR(found.y, truth.y, 0.06);
  EXPECT_NEAR(degrees(wrap_angle(found.yaw - truth.yaw)), 0.0, 0.5);
  EXPECT_GT(result.candidates.front().score, 0.7);
}

INSTANTIATE_TEST_SUITE_P(EveryBackend, HeightMatchTest,
                         testing::Values(Backend::kCpu, Backend::kReference),
                         [](const auto& tested) {
                           return std::string(tested.param == Backend::kCpu ? "cpu" : "reference");
                         });

}  // namespace
}  // namespace nadir
