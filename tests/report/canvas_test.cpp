// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/canvas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/nan.hpp"

namespace nadir::report {
namespace {

using test::kNan;

Colour pixel(const Raster<std::uint8_t>& figure, int column, int row) {
  return {figure.at(column, row, 0), figure.at(column, row, 1), figure.at(column, row, 2)};
}

int painted_pixels(const Raster<std::uint8_t>& figure) {
  int count = 0;
  for (int row = 0; row < figure.height(); ++row) {
    for (int column = 0; column < figure.width(); ++column) {
      if (pixel(figure, column, row) != kPaper) ++count;
    }
  }
  return count;
}

TEST(Canvas, StartsAsPaperOfTheRightSize) {
  const auto figure = Canvas(40, 30).finish();
  EXPECT_EQ(figure.width(), 40);
  EXPECT_EQ(figure.height(), 30);
  EXPECT_EQ(figure.channels(), 3);
  EXPECT_EQ(painted_pixels(figure), 0);
}

TEST(Canvas, FillCoversItsPixelsAndNoMore) {
  Canvas canvas(40, 30);
  canvas.fill(Box{10.0, 5.0, 12.0, 8.0}.corners(), kBlue);
  const auto figure = canvas.finish();
  EXPECT_EQ(pixel(figure, 11, 6), kBlue);
  EXPECT_EQ(pixel(figure, 20, 11), kBlue);
  EXPECT_EQ(pixel(figure, 8, 6), kPaper);
  EXPECT_EQ(pixel(figure, 24, 6), kPaper);
}

TEST(Canvas, HalfOpacityIsHalfway) {
  Canvas canvas(20, 20);
  canvas.fill(Box{0.0, 0.0, 20.0, 20.0}.corners(), {0, 0, 0}, 0.5);
  EXPECT_NEAR(canvas.finish().at(10, 10, 0), 128, 2);
}

TEST(Canvas, NothingIsDrawnOutsideTheClip) {
  Canvas canvas(60, 60);
  canvas.clip({20.0, 20.0, 20.0, 20.0});
  canvas.line({{0.0, 30.0}, {60.0, 30.0}}, {kVermillion, 4.0, {}, 0.0});
  canvas.disc({20.0, 20.0}, 15.0, kBlue);
  canvas.unclip();
  const auto figure = canvas.finish();
  EXPECT_EQ(pixel(figure, 38, 30), kVermillion);
  for (int i = 0; i < 60; ++i) {
    EXPECT_EQ(pixel(figure, i, 18), kPaper);
    EXPECT_EQ(pixel(figure, 18, i), kPaper);
    EXPECT_EQ(pixel(figure, 42, i), kPaper);
  }
}

TEST(Canvas, PointsThatAreNotFiniteBreakTheLine) {
  Canvas canvas(100, 20);
  const Stroke stroke{kInk, 3.0, {}, 0.0};
  canvas.line({{5.0, 10.0}, {30.0, 10.0}, {kNan, 10.0}, {70.0, 10.0}, {95.0, 10.0}}, stroke);
  canvas.disc({kNan, 3.0}, 5.0, kInk);
  canvas.fill({{kNan, 0.0}, {1.0, 1.0}, {2.0, 0.0}}, kInk);
  canvas.arrow({kNan, 0.0}, {5.0, 5.0}, stroke);
  const auto figure = canvas.finish();
  EXPECT_EQ(pixel(figure, 20, 9), kInk);
  EXPECT_EQ(pixel(figure, 50, 9), kPaper);
  EXPECT_EQ(pixel(figure, 80, 9), kInk);
}

TEST(Canvas, FarAwayPointsDoNotOverflow) {
  Canvas canvas(50, 50);
  canvas.line({{-1e12, 25.0}, {1e12, 25.0}}, {kInk, 3.0, {}, 0.0});
  EXPECT_EQ(pixel(canvas.finish(), 25, 24), kInk);
}

TEST(Canvas, DashesLeaveGaps) {
  Canvas canvas(100, 10);
  canvas.line({{0.0, 5.0}, {100.0, 5.0}}, {kInk, 4.0, {}, 20.0});
  const auto figure = canvas.finish();
  EXPECT_EQ(pixel(figure, 10, 4), kInk);
  EXPECT_EQ(pixel(figure, 30, 4), kPaper);
  EXPECT_EQ(pixel(figure, 50, 4), kInk);
}

TEST(Canvas, TextIsAsWideAsMeasured) {
  const TextStyle style{24.0, kInk, Align::kCentre, false, {}};
  const double width = text_width("trajectory", style);
  Canvas canvas(300, 60);
  canvas.text({150.0, 30.0}, "trajectory", style);
  const auto figure = canvas.finish();
  int left = 300;
  int right = 0;
  for (int row = 0; row < 60; ++row) {
    for (int column = 0; column < 300; ++column) {
      if (pixel(figure, column, row) == kPaper) continue;
      left = std::min(left, column);
      right = std::max(right, column);
    }
  }
  EXPECT_NEAR(0.5 * (left + right), 150.0, 6.0);
  EXPECT_NEAR(right - left, width, 10.0);
}

TEST(Canvas, FittedTextStaysInItsRoom) {
  Canvas canvas(200, 60);
  canvas.fitted_text({20.0, 30.0}, "a name that is far too long for the room it is given", 100.0,
                     {24.0, kInk, Align::kLeft, false, {}});
  const auto figure = canvas.finish();
  for (int row = 0; row < 60; ++row) {
    for (int column = 124; column < 200; ++column) EXPECT_EQ(pixel(figure, column, row), kPaper);
  }
}

TEST(Canvas, AnyBytesAreATextThatCanBeSet) {
  Canvas canvas(300, 60);
  canvas.text({10.0, 30.0}, "±5° – ü \xFF\xC3\n\t", {});
  EXPECT_GT(painted_pixels(canvas.finish()), 50);
  EXPECT_EQ(text_width("", {}), 0.0);
  EXPECT_GT(text_width("5°", {}), text_width("5", {}));
}

TEST(Colours, MapsAreClampedAndGrowBrighter) {
  for (const ColourMap map : {ColourMap::kInferno, ColourMap::kViridis}) {
    EXPECT_EQ(mapped_colour(map, -3.0), mapped_colour(map, 0.0));
    EXPECT_EQ(mapped_colour(map, 7.0), mapped_colour(map, 1.0));
    EXPECT_LT(mapped_colour(map, 0.2).green, mapped_colour(map, 0.8).green);
  }
}

}  // namespace
}  // namespace nadir::report
