// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace nadir::aerial {
namespace {

/// A strip of photos each of which overlaps the next two; `ratio` is what the second of a pair
/// looks darker by.
std::vector<Overlap> strip(std::size_t photos, double ratio, double cells = 1000.0) {
  std::vector<Overlap> overlaps;
  for (std::size_t i = 0; i < photos; ++i)
    for (std::size_t step = 1; step <= 2 && i + step < photos; ++step) {
      const double second = 100.0 / std::pow(ratio, static_cast<double>(step));
      overlaps.push_back({i, i + step, cells, {100, 100, 100}, {second, second, second}});
    }
  return overlaps;
}

double luminance(const std::array<float, 3>& gain) {
  return 0.299 * gain[0] + 0.587 * gain[1] + 0.114 * gain[2];
}

TEST(Exposure, GainsUndoTheExposuresOfThePhotos) {
  // Photos 0 and 2 got twice the light of photo 1, and look it.
  const double brighter = std::pow(2.0, 1.0 / 2.2);
  const double dark = 100.0 / brighter;
  const std::vector<Overlap> overlaps{{0, 1, 1000, {100, 100, 100}, {dark, dark, dark}},
                                      {1, 2, 1000, {dark, dark, dark}, {100, 100, 100}}};
  const auto gains = balance(overlaps, {2.0, 1.0, 2.0}, 0.1);
  EXPECT_NEAR(gains[1][0] / gains[0][0], brighter, 0.01);
  EXPECT_NEAR(gains[0][0], 1.0, 0.01);  // the median
}

TEST(Exposure, ARatioThatRepeatsDoesNotDriftAlongAStrip) {
  // 4 per cent a step, from the side that the sun comes from: unheld, 2.1 at the end of 20 photos.
  const std::size_t photos = 20;
  const auto gains = balance(strip(photos, 1.04), std::vector<std::optional<double>>(photos), 0.1);
  double lowest = 1e9;
  double highest = 0.0;
  for (const auto& gain : gains) {
    lowest = std::min(lowest, luminance(gain));
    highest = std::max(highest, luminance(gain));
  }
  EXPECT_LT(highest / lowest, 0.75 * std::pow(1.04, 19.0));
  EXPECT_GT(highest / lowest, 1.05);  // it is not ignored either
  // A tight prior holds it.
  const auto held = balance(strip(photos, 1.04), std::vector<std::optional<double>>(photos), 0.01);
  EXPECT_LT(luminance(held.back()) / luminance(held.front()), 1.05);
}

TEST(Exposure, ChromaStaysWithinFivePerCent) {
  const std::vector<Overlap> overlaps{{0, 1, 1e4, {100, 100, 100}, {150, 100, 60}}};
  const auto gains = balance(overlaps, {std::nullopt, std::nullopt}, 0.1);
  for (const auto& gain : gains)
    for (const float channel : gain) {
      EXPECT_GT(channel / luminance(gain), 0.94 / 1.01);
      EXPECT_LT(channel / luminance(gain), 1.06 * 1.01);
    }
}

TEST(Exposure, NothingOverlapsNothingChanges) {
  const auto gains = balance({}, {std::nullopt, std::nullopt, std::nullopt}, 0.1);
  for (const auto& gain : gains)
    for (const float channel : gain) EXPECT_FLOAT_EQ(channel, 1.0F);
}

}  // namespace
}  // namespace nadir::aerial
