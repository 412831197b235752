// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/figures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/report/map_figure.hpp"
#include "support/nan.hpp"

namespace nadir {
namespace {

using report::Colour;
using test::kNan;

Orthomosaic grey_map(int width = 400, int height = 300) {
  return {Raster<std::uint8_t>(width, height, 120),
          Raster<std::uint8_t>(width, height, 255),
          {0.0, 0.1 * height, 0.1, {}}};
}

Orthomosaic grey_local() {
  return {
      Raster<std::uint8_t>(60, 60, 90), Raster<std::uint8_t>(60, 60, 255), {-3.0, 3.0, 0.1, {}}};
}

Trajectory straight(double y, int poses = 5) {
  Trajectory trajectory;
  for (int i = 0; i < poses; ++i) {
    trajectory.push_back({Stamp{i * 1000000000LL}, Pose2{8.0 + 5.0 * i, y, 0.0}});
  }
  return trajectory;
}

Colour pixel(const Figure& figure, report::Position at) {
  const int column = static_cast<int>(at.x);
  const int row = static_cast<int>(at.y);
  return {figure.at(column, row, 0), figure.at(column, row, 1), figure.at(column, row, 2)};
}

void expect_colour(Colour seen, Colour wanted) {
  EXPECT_NEAR(seen.red, wanted.red, 12);
  EXPECT_NEAR(seen.green, wanted.green, 12);
  EXPECT_NEAR(seen.blue, wanted.blue, 12);
}

int count_near(const Figure& figure, Colour wanted) {
  int count = 0;
  for (int row = 0; row < figure.height(); ++row) {
    for (int column = 0; column < figure.width(); ++column) {
      const bool near = std::abs(figure.at(column, row, 0) - wanted.red) < 6 &&
                        std::abs(figure.at(column, row, 1) - wanted.green) < 6 &&
                        std::abs(figure.at(column, row, 2) - wanted.blue) < 6;
      count += near ? 1 : 0;
    }
  }
  return count;
}

void expect_sensible_size(const Figure& figure) {
  EXPECT_EQ(figure.channels(), 3);
  EXPECT_GE(std::min(figure.width(), figure.height()), 400);
  EXPECT_GE(std::max(figure.width(), figure.height()), 1200);
  EXPECT_LE(std::max(figure.width(), figure.height()), 2300);
}

ScoreVolume peaked_volume() {
  ScoreVolume volume;
  volume.geo = {12.0, 20.0, 0.5, {}};
  volume.yaws = {0.0};
  volume.score = {Raster<float>(20, 20, 0.0F)};
  volume.score[0].at(10, 10) = 1.0F;
  volume.valid_weight = {Raster<float>(20, 20, 1.0F)};
  return volume;
}

HeatMap heat_map_of(const ScoreVolume& volume) {
  const GeoReference geo = grey_local().geo;
  return {&volume, Footprint{Pose2{17.25, 14.75, 0.3}, geo, 60, 60},
          Footprint{Pose2{16.0, 15.0, 0.2}, geo, 60, 60}, false, "a title"};
}

TEST(DrawTrajectories, TracksHaveTheirColourAtTheirPlace) {
  const std::vector<Track> tracks{{"a", straight(12.0)}, {"b", straight(18.0)}};
  const Figure figure = draw_trajectories(grey_map(), tracks, "a title");
  expect_sensible_size(figure);
  report::Region content;
  content.include(8.0, 12.0);
  content.include(28.0, 18.0);
  const auto region = report::region_of_interest(content, {0.0, 0.0, 40.0, 30.0, false}, 5.0);
  const report::MapLayout layout = report::lay_out_map(region, tracks.size() + 2);
  ASSERT_EQ(figure.width(), layout.width);
  ASSERT_EQ(figure.height(), layout.height);
  expect_colour(pixel(figure, layout.view.at(15.5, 12.0)), report::track_colour(0));
  expect_colour(pixel(figure, layout.view.at(15.5, 18.0)), report::track_colour(1));
  const Colour ground = pixel(figure, layout.view.at(15.5, 15.0));
  expect_colour(ground, {120, 120, 120});
}

TEST(DrawTrajectories, FirstTrackIsOnTopAndTheOtherShowsBeneath) {
  const Figure both =
      draw_trajectories(grey_map(), {{"a", straight(15.0)}, {"b", straight(15.0)}}, "");
  EXPECT_GT(count_near(both, report::track_colour(0)), 2000);
  EXPECT_GT(count_near(both, report::track_colour(1)), 300);
}

TEST(DrawTrajectories, SameInputSameBytes) {
  const std::vector<Track> tracks{{"a", straight(12.0)}};
  EXPECT_EQ(draw_trajectories(grey_map(), tracks, "t"), draw_trajectories(grey_map(), tracks, "t"));
}

TEST(DrawTrajectories, EmptyInputsAreDrawn) {
  expect_sensible_size(draw_trajectories(grey_map(), {}, ""));
  expect_sensible_size(draw_trajectories(grey_map(), {{"empty", {}}}, "none"));
  expect_sensible_size(draw_trajectories({}, {}, "no map"));
  expect_sensible_size(draw_trajectories({}, {{"a", straight(3.0)}}, "no map"));
  Trajectory broken = straight(12.0);
  broken[2].pose.x = kNan;
  expect_sensible_size(draw_trajectories(grey_map(), {{"broken", broken}}, "NaN"));
  for (auto& stamped : broken) stamped.pose.y = kNan;
  expect_sensible_size(draw_trajectories(grey_map(), {{"broken", broken}}, "all NaN"));
}

TEST(DrawTrajectories, OnePoseOffTheMapIsDrawn) {
  const Trajectory far{{Stamp{}, Pose2{500.0, 500.0, 0.0}}};
  expect_sensible_size(draw_trajectories(grey_map(), {{"far", far}}, ""));
}

TEST(DrawTrajectories, ManyTracksFit) {
  std::vector<Track> tracks;
  for (int i = 0; i < 12; ++i)
    tracks.push_back({"a rather long name of a track", straight(i + 5.0)});
  expect_sensible_size(draw_trajectories(grey_map(), tracks, std::string(300, 'x')));
}

TEST(DrawTrajectories, TallAndUtmSizedMapsAreReadable) {
  Orthomosaic map = grey_map(150, 400);
  map.geo.west = 512000.0;
  map.geo.north = 5267040.0;
  Trajectory north;
  for (int i = 0; i < 30; ++i) north.push_back({Stamp{i}, Pose2{512007.0, 5267003.0 + i, 1.5}});
  expect_sensible_size(draw_trajectories(map, {{"north", north}}, "tall"));
}

TEST(DrawSwarms, EstimateAndTruthAreThere) {
  Swarm swarm{"frame 1", {}, {}, Pose2{15.0, 15.0, 0.4}, Pose2{16.0, 15.2, 0.3}};
  for (int i = 0; i < 50; ++i) {
    swarm.particles.push_back({15.0 + 0.02 * i, 15.0 + 0.01 * i, 0.4});
    swarm.weights.push_back(0.02);
  }
  Swarm later = swarm;
  later.truth.reset();
  for (const std::size_t count : {1U, 2U, 5U, 9U}) {
    std::vector<Swarm> swarms(count, later);
    swarms.front() = swarm;
    const Figure figure = draw_swarms(grey_map(), swarms, "a title");
    expect_sensible_size(figure);
    EXPECT_GT(count_near(figure, report::kVermillion), 500);
    EXPECT_GT(count_near(figure, report::kSkyBlue), 100);
  }
}

TEST(DrawSwarms, EmptyAndBrokenInputsAreDrawn) {
  expect_sensible_size(draw_swarms({}, {}, ""));
  draw_swarms(grey_map(), {}, "no swarm");
  const Swarm none{"none", {}, {}, Pose2{kNan, kNan, kNan}, {}};
  expect_sensible_size(draw_swarms(grey_map(), {none}, "no particle"));
  const Swarm uneven{"uneven", {Pose2{1, 2, 0}, Pose2{kNan, 2, 0}}, {0.0}, Pose2{3, 2, 0}, {}};
  expect_sensible_size(draw_swarms(grey_map(), {uneven}, "fewer weights than particles"));
}

TEST(DrawHeatMap, BoxesAndPeakHaveTheirColours) {
  const ScoreVolume volume = peaked_volume();
  const Figure figure = draw_heat_map(grey_map(), grey_local(), heat_map_of(volume));
  expect_sensible_size(figure);
  EXPECT_GT(count_near(figure, report::kTruthBlue), 1000);
  EXPECT_GT(count_near(figure, report::kSearchRed), 1000);
  HeatMap whole = heat_map_of(volume);
  whole.whole_map = true;
  whole.truth.reset();
  const Figure bare = draw_heat_map(grey_map(), grey_local(), whole);
  EXPECT_EQ(count_near(bare, report::kTruthBlue), 0);
  EXPECT_EQ(count_near(bare, report::kSearchRed), 0);
}

/// Bounding box, in pixels, of a colour above the legend.
report::Box bounds_of(const Figure& figure, Colour wanted) {
  constexpr int kLegendRows = 180;
  report::Region bounds;
  for (int row = 0; row < figure.height() - kLegendRows; ++row) {
    for (int column = 0; column < figure.width(); ++column) {
      const bool near = std::abs(figure.at(column, row, 0) - wanted.red) < 6 &&
                        std::abs(figure.at(column, row, 1) - wanted.green) < 6 &&
                        std::abs(figure.at(column, row, 2) - wanted.blue) < 6;
      if (near) bounds.include(column, row);
    }
  }
  return {bounds.west, bounds.south, bounds.width(), bounds.height()};
}

TEST(DrawHeatMap, TruthBoxLiesWhereTheWindowSaysItMust) {
  const ScoreVolume volume = peaked_volume();  // window: 12 .. 22 m east, 10 .. 20 m north
  HeatMap heat_map = heat_map_of(volume);
  heat_map.truth->map_from_robot = {16.0, 14.5, 0.0};
  heat_map.found.map_from_robot = {20.0, 18.0, 0.1};
  const Figure figure = draw_heat_map(grey_map(), grey_local(), heat_map);
  const report::Box window = bounds_of(figure, report::kSearchRed);
  const report::Box truth = bounds_of(figure, report::kTruthBlue);
  const double scale = window.width / 10.0;  // pixels per metre
  EXPECT_NEAR(window.height, window.width, 4.0);
  EXPECT_NEAR(truth.height, 6.0 * scale, 6.0);
  EXPECT_NEAR(truth.left - window.left, (13.0 - 12.0) * scale, 6.0);
  EXPECT_NEAR(truth.top - window.top, (20.0 - 17.5) * scale, 6.0);
}

TEST(DrawHeatMap, UndefinedScoresLeaveTheMapBare) {
  ScoreVolume volume = peaked_volume();
  HeatMap heat_map = heat_map_of(volume);
  const auto lifted = static_cast<std::uint8_t>(std::lround(120 + 0.12 * 135));
  const Colour map_grey{lifted, lifted, lifted};
  const int covered = count_near(draw_heat_map(grey_map(), grey_local(), heat_map), map_grey);
  std::fill(volume.score[0].values().begin(), volume.score[0].values().end(),
            std::numeric_limits<float>::quiet_NaN());
  const int bare = count_near(draw_heat_map(grey_map(), grey_local(), heat_map), map_grey);
  EXPECT_GT(bare, covered + 100000);
}

TEST(DrawHeatMap, EmptyInputsAreDrawn) {
  const ScoreVolume empty;
  HeatMap heat_map = heat_map_of(empty);
  expect_sensible_size(draw_heat_map(grey_map(), grey_local(), heat_map));
  heat_map.volume = nullptr;
  expect_sensible_size(draw_heat_map(grey_map(), {}, heat_map));
  heat_map.found.map_from_robot.x = kNan;
  expect_sensible_size(draw_heat_map(grey_map(), grey_local(), heat_map));
  expect_sensible_size(draw_heat_map({}, {}, HeatMap{}));
  const ScoreVolume flat = [] {
    ScoreVolume volume = peaked_volume();
    volume.score[0].at(10, 10) = 0.0F;
    return volume;
  }();
  expect_sensible_size(draw_heat_map(grey_map(), grey_local(), heat_map_of(flat)));
}

TEST(DrawPanels, CurvesHaveGapsWhereValuesAreMissing) {
  std::vector<double> x;
  std::vector<double> y;
  for (int i = 0; i <= 100; ++i) {
    x.push_back(i);
    y.push_back(i > 20 && i < 80 ? kNan : 1.0);
  }
  const Curve with_gap{"", x, y};
  const Curve whole{"", x, std::vector<double>(101, 1.0)};
  const auto drawn = [](const Curve& curve) {
    return count_near(draw_panels({{"value", {curve}}}, "frame", ""), report::kVermillion);
  };
  EXPECT_NEAR(static_cast<double>(drawn(with_gap)) / drawn(whole), 0.4, 0.05);
}

TEST(DrawPanels, WhatIsConstantUpToRoundingIsDrawnAsConstant) {
  const auto drawn = [](double x, double y) {
    return draw_panels({{"value", {{"a", {3.0, x}, {0.3, y}}}}}, "frame", "");
  };
  EXPECT_EQ(drawn(4.0, 0.3), drawn(4.0, 0.1 + 0.2));
  EXPECT_EQ(drawn(3.0, 0.3), drawn(30.0 * 0.1 * (1.0 + 1e-15), 0.3));
}

TEST(DrawPanels, EmptyAndOddInputsAreDrawn) {
  expect_sensible_size(draw_panels({}, "", ""));
  expect_sensible_size(draw_panels({{"nothing", {}}}, "frame", "t"));
  expect_sensible_size(draw_panels({{"NaN", {{"a", {1.0, 2.0}, {kNan, kNan}}}}}, "frame", "t"));
  expect_sensible_size(draw_panels({{"uneven", {{"a", {1.0, 2.0, 3.0}, {5.0}}}}}, "frame", "t"));
  const double huge = 1e300;
  expect_sensible_size(draw_panels({{"huge", {{"a", {0.0, 1.0}, {-huge, huge}}}}}, "x", "t"));
  const double infinity = std::numeric_limits<double>::infinity();
  expect_sensible_size(draw_panels({{"inf", {{"a", {0.0, 1.0}, {1.0, infinity}}}}}, "x", "t"));
}

TEST(DrawPanels, ABandIsFilledBelowItsCurveAndNamed) {
  const Curve line{"error", {0.0, 10.0}, {0.5, 0.5}};
  const Band band{"2 sigma", {0.0, 10.0}, {0.0, 0.0}, {1.0, 1.0}};
  const auto sky = [](const std::vector<Band>& bands, const Curve& curve) {
    const Colour light{204, 232, 248};  // 30 % of the sky blue on paper
    return count_near(draw_panels({{"m", {curve}, bands}}, "s", ""), light);
  };
  EXPECT_EQ(sky({}, line), 0);
  EXPECT_GT(sky({band}, line), 200000);
  Band broken = band;
  broken.high[1] = kNan;
  EXPECT_LT(sky({broken}, line), 2000);
}

TEST(DrawComparisons, ARowForEachWithItsThreePatches) {
  const auto row = [](const std::string& label) {
    return Comparison{label, grey_local(), Pose2{20.0, 15.0, 0.5}};
  };
  const Figure one = draw_comparisons(grey_map(), {row("frame 1")}, "a title");
  const Figure two = draw_comparisons(grey_map(), {row("frame 1"), row("frame 2")}, "a title");
  EXPECT_EQ(one.width(), two.width());
  EXPECT_GT(two.height(), one.height() + 400);
  // The local map is of grey 90, the map of 120: the checkerboard is half of each.
  const int locals = count_near(one, {90, 90, 90});
  const int maps = count_near(one, {120, 120, 120});
  EXPECT_NEAR(locals, 1.5 * 420 * 420, 30000);
  EXPECT_NEAR(maps, 1.5 * 420 * 420, 30000);
}

TEST(DrawComparisons, EmptyAndBrokenInputsAreDrawn) {
  draw_comparisons(grey_map(), {}, "none");
  draw_comparisons({}, {{"no map", grey_local(), Pose2{}}}, "");
  draw_comparisons(grey_map(), {{"no local map", {}, Pose2{}}}, "");
  draw_comparisons(grey_map(), {{"no pose", grey_local(), Pose2{kNan, 0.0, 0.0}}}, "");
}

TEST(DrawCoverage, WhatWasSeenOftenestIsBrightest) {
  const SeenGround there = seen_ground(grey_local(), Pose2{12.0, 15.0, 0.0});
  Orthomosaic half = grey_local();  // its right half, x > 24, is holes
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 60; ++column) half.valid.at(column, row) = column < 30 ? 1 : 0;
  }
  const SeenGround ahead = seen_ground(half, Pose2{24.0, 15.0, 0.0});
  const Figure figure = draw_coverage(grey_map(), {there, there, there, ahead}, "a title");
  expect_sensible_size(figure);
  report::Region content;
  content.include(9.0, 12.0);
  content.include(27.0, 18.0);
  const auto region = report::region_of_interest(content, {0.0, 0.0, 40.0, 30.0, false}, 3.0);
  const report::MapView view = report::lay_out_map(region, 0).view;
  const Colour often = pixel(figure, view.at(12.0, 15.0));
  const Colour once = pixel(figure, view.at(22.5, 15.0));
  EXPECT_GT(often.green, once.green + 50);
  for (const double x : {18.0, 25.5}) {
    const Colour never = pixel(figure, view.at(x, 15.0));
    EXPECT_EQ(never.red, never.blue) << x;
  }
}

TEST(DrawCoverage, EmptyAndBrokenInputsAreDrawn) {
  expect_sensible_size(draw_coverage(grey_map(), {}, "none"));
  expect_sensible_size(
      draw_coverage(grey_map(), {seen_ground(grey_local(), Pose2{kNan, 1.0, 0.0})}, "NaN"));
  expect_sensible_size(draw_coverage({}, {seen_ground(grey_local(), Pose2{})}, "no map"));
  expect_sensible_size(
      draw_coverage(grey_map(), {seen_ground({}, Pose2{5.0, 5.0, 0.0})}, "nothing"));
}

TEST(DrawConventions, IsTheSameEveryTime) {
  const Figure figure = draw_conventions();
  expect_sensible_size(figure);
  EXPECT_EQ(figure, draw_conventions());
}

}  // namespace
}  // namespace nadir
