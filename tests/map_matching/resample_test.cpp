// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/resample.hpp"

#include <gtest/gtest.h>

#include "nadir/core/random.hpp"

namespace nadir {
namespace {

GreyImage random_grey(std::uint64_t seed, int width, int height, double resolution,
                      double hole_share) {
  const RandomStream random(seed, 0);
  GreyImage image{Raster<float>(width, height),
                  Raster<std::uint8_t>(width, height),
                  {2.0, 9.0, resolution, {}}};
  for (std::size_t i = 0; i < image.value.values().size(); ++i) {
    const auto [grey, hole] = random.uniform_pair(i);
    if (hole < hole_share) continue;
    image.valid.values()[i] = 1;
    image.value.values()[i] = static_cast<float>(255.0 * grey);
  }
  return image;
}

/// The area average by brute force: every pixel split into 20 x 20 points.
double sampled_mean(const GreyImage& image, double left, double top, double side) {
  constexpr int kPoints = 20;
  double sum = 0.0;
  double count = 0.0;
  const int steps = static_cast<int>(side * kPoints);
  for (int j = 0; j < steps; ++j) {
    for (int i = 0; i < steps; ++i) {
      const int column = static_cast<int>(left + (i + 0.5) / kPoints);
      const int row = static_cast<int>(top + (j + 0.5) / kPoints);
      if (!image.valid.contains(column, row) || image.valid.at(column, row) == 0) continue;
      sum += image.value.at(column, row);
      count += 1.0;
    }
  }
  return sum / count;
}

TEST(Resample, IsTheMaskedAreaAverage) {
  const GreyImage image = random_grey(1, 33, 21, 0.04, 0.2);
  const GreyImage coarse = resample(image, 0.1);  // 2.5 pixels a cell
  EXPECT_EQ(coarse.value.width(), 14);
  EXPECT_EQ(coarse.value.height(), 9);
  EXPECT_EQ(coarse.geo.west, image.geo.west);
  EXPECT_EQ(coarse.geo.north, image.geo.north);
  for (int row = 0; row < coarse.value.height(); ++row) {
    for (int column = 0; column < coarse.value.width(); ++column) {
      if (coarse.valid.at(column, row) == 0) continue;
      EXPECT_NEAR(coarse.value.at(column, row), sampled_mean(image, 2.5 * column, 2.5 * row, 2.5),
                  1e-3);
    }
  }
}

TEST(Resample, SameResolutionIsTheSameImage) {
  const GreyImage image = random_grey(2, 10, 7, 0.1, 0.5);
  const GreyImage same = resample(image, 0.1);
  EXPECT_EQ(same.value, image.value);
  EXPECT_EQ(same.valid, image.valid);
}

TEST(Resample, KeepsTheMiddleOfAnUpsampledPixel) {
  const GreyImage image = random_grey(3, 8, 5, 0.3, 0.0);
  const GreyImage fine = resample(image, 0.1);
  EXPECT_EQ(fine.value.width(), 24);
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 8; ++column) {
      EXPECT_NEAR(fine.value.at(3 * column + 1, 3 * row + 1), image.value.at(column, row), 1e-3);
    }
  }
}

TEST(Resample, ACellThatIsMostlyHoleIsAHole) {
  GreyImage image = random_grey(4, 4, 4, 0.05, 0.0);
  image.valid.at(0, 0) = image.valid.at(1, 0) = image.valid.at(0, 1) = 0;
  const GreyImage coarse = resample(image, 0.1);
  EXPECT_EQ(coarse.valid.at(0, 0), 0);
  EXPECT_EQ(coarse.valid.at(1, 1), 1);
}

}  // namespace
}  // namespace nadir
