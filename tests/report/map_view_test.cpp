// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/map_view.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nadir/core/angle.hpp"
#include "nadir/report/imagery.hpp"
#include "nadir/report/map_figure.hpp"

namespace nadir::report {
namespace {

/// A map of 20 x 10 m: red in its north-west quarter, else blue; its south-east pixel is a hole
/// with a glaring colour.
Orthomosaic quarters() {
  Orthomosaic map{Raster<std::uint8_t>(40, 20, 0, 3),
                  Raster<std::uint8_t>(40, 20, 255),
                  {100.0, 50.0, 0.5, {}}};
  for (int row = 0; row < 20; ++row) {
    for (int column = 0; column < 40; ++column) {
      map.image.at(column, row, column < 20 && row < 10 ? 0 : 2) = 200;
    }
  }
  for (int channel = 0; channel < 3; ++channel) map.image.at(39, 19, channel) = 255;
  map.valid.at(39, 19) = 0;
  return map;
}

TEST(Region, LeavesOutWhatIsNotFinite) {
  Region region;
  region.include(std::numeric_limits<double>::quiet_NaN(), 1.0);
  EXPECT_TRUE(region.empty);
  region.include(3.0, 4.0);
  region.include(-1.0, 6.0);
  EXPECT_EQ(region, (Region{-1.0, 4.0, 3.0, 6.0, false}));
}

TEST(MapView, NorthIsUpAndScaleIsEqual) {
  const MapView view = fit({0.0, 0.0, 20.0, 10.0, false}, {50.0, 60.0, 400.0, 400.0});
  EXPECT_DOUBLE_EQ(view.pixels_per_metre(), 20.0);
  EXPECT_DOUBLE_EQ(view.box.height, 200.0);
  EXPECT_DOUBLE_EQ(view.at(0.0, 10.0).x, 50.0);
  EXPECT_DOUBLE_EQ(view.at(0.0, 10.0).y, 60.0);
  EXPECT_DOUBLE_EQ(view.at(5.0, 5.0).x, 150.0);
  EXPECT_DOUBLE_EQ(view.at(5.0, 5.0).y, 160.0);
}

TEST(MapView, OutlineIsTurnedByThePose) {
  const GeoReference geo{-2.0, 1.0, 0.1, {}};  // 4 m ahead and behind, 2 m across
  const auto corners = outline_of(Pose2{10.0, 20.0, 0.5 * kPi}, geo, 40, 20);
  EXPECT_NEAR(corners[0].x, 9.0, 1e-9);  // front left: forward is north, left is west
  EXPECT_NEAR(corners[0].y, 22.0, 1e-9);
  EXPECT_NEAR(corners[2].x, 11.0, 1e-9);
  EXPECT_NEAR(corners[2].y, 18.0, 1e-9);
}

TEST(DrawMap, ShowsEachPlaceWhereItLies) {
  const Orthomosaic map = quarters();
  const MapView view = fit({100.0, 40.0, 120.0, 50.0, false}, {10.0, 10.0, 400.0, 200.0});
  Canvas canvas(420, 220);
  draw_map(canvas, view, map, Tint::kColour);
  const auto figure = canvas.finish();
  EXPECT_EQ(figure.at(100, 50, 0), 200);  // north-west
  EXPECT_EQ(figure.at(100, 50, 2), 0);
  EXPECT_EQ(figure.at(300, 50, 2), 200);
  EXPECT_EQ(figure.at(100, 150, 0), 0);
  // The border between the quarters is at 110 m east: 200 pixels from the left edge of the map.
  EXPECT_GT(figure.at(205, 50, 0), 140);
  EXPECT_LT(figure.at(215, 50, 0), 60);
}

TEST(DrawMap, HolesAreHatchedAndDoNotBleed) {
  const Orthomosaic map = quarters();
  const MapView view = fit({115.0, 35.0, 125.0, 45.0, false}, {0.0, 0.0, 400.0, 400.0});
  Canvas canvas(400, 400);
  draw_map(canvas, view, map, Tint::kColour);
  const auto figure = canvas.finish();
  const auto is_neutral = [&](int column, int row) {
    return figure.at(column, row, 0) >= kHatching.red && figure.at(column, row, 0) < 245;
  };
  EXPECT_TRUE(is_neutral(350, 350));  // outside the map
  EXPECT_TRUE(is_neutral(190, 190));  // the hole, 119.75 m east and 40.25 m north
  EXPECT_EQ(figure.at(100, 100, 2), 200);
}

TEST(Resample, AveragesWhereItShrinks) {
  Orthomosaic map{Raster<std::uint8_t>(64, 64), Raster<std::uint8_t>(64, 64, 255), {}};
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 64; ++column) {
      map.image.at(column, row) = (row + column) % 2 == 0 ? 200 : 100;
    }
  }
  const Imagery small = resample(map, {8.0, 0.0, 0.0, 0.0, 8.0, 0.0}, 8, 8);
  EXPECT_NEAR(small.colour.at(4, 4, 0), 150, 1);
  EXPECT_EQ(small.opacity.at(4, 4), 255);
}

TEST(RegionOfInterest, HasAMarginAndStaysInTheMap) {
  const Region map{0.0, 0.0, 40.0, 115.0, false};
  Region track;
  track.include(10.0, 60.0);
  track.include(12.0, 100.0);
  const Region shown = region_of_interest(track, map, 5.0);
  EXPECT_LE(shown.west, 5.0);
  EXPECT_GE(shown.east, 17.0);
  EXPECT_GE(shown.north, 105.0);
  EXPECT_GE(shown.west, map.west);
  EXPECT_LE(shown.east, map.east);
  EXPECT_LT(shown.height() / shown.width(), 3.0);
}

TEST(LayOutMap, KeepsTheLegendBesideTheMap) {
  for (const Region& region :
       {Region{0.0, 0.0, 20.0, 60.0, false}, Region{0.0, 0.0, 60.0, 20.0, false}}) {
    const MapLayout layout = lay_out_map(region, 5);
    const bool beside = layout.legend.left >= layout.view.box.right();
    const bool below = layout.legend.top >= layout.view.box.bottom();
    EXPECT_TRUE(beside || below);
    EXPECT_LE(layout.legend.right(), layout.width);
    EXPECT_LE(layout.legend.bottom(), layout.height);
    EXPECT_LE(layout.furniture.bottom(), layout.height);
    EXPECT_LE(std::max(layout.width, layout.height), 2000);
  }
}

}  // namespace
}  // namespace nadir::report
