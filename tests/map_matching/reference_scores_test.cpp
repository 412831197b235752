// SPDX-License-Identifier: Apache-2.0
// The reference itself, against cases worked by hand.
#include "nadir/map_matching/reference/scores.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "nadir/map_matching/rotated_template.hpp"

namespace nadir {
namespace {

using reference::PixelPairs;
using reference::score;

// R = 10, 20, 30, 60; P = 20, 10, 50, 40; w = 2, 1, 1, 2.
const PixelPairs kPairs{{10, 20, 30, 60}, {20, 10, 50, 40}, {2, 1, 1, 2}};

TEST(ReferenceScores, DistancesByHand) {
  // Differences 10, 10, 20, 20.
  EXPECT_DOUBLE_EQ(score(Score::kSsd, kPairs), -(100 + 100 + 400 + 400) / 4.0);
  EXPECT_DOUBLE_EQ(score(Score::kSad, kPairs), -60 / 4.0);
}

TEST(ReferenceScores, CosinesByHand) {
  // sum R P = 200 + 200 + 1500 + 2400, sum R^2 = 5000, sum P^2 = 4600; sum w R P = 6900.
  EXPECT_DOUBLE_EQ(score(Score::kNcc, kPairs), 4300 / std::sqrt(5000.0 * 4600.0));
  EXPECT_DOUBLE_EQ(score(Score::kWncc, kPairs), 6900 / std::sqrt(5000.0 * 4600.0));
}

TEST(ReferenceScores, PaperEquation5ByHand) {
  // Means 30 and 30: |R - 30| = 20, 10, 0, 30; |P - 30| = 10, 20, 20, 10.
  // sum w |.||.| = 2*200 + 200 + 0 + 2*300 = 1200; norms 1400 and 1000.
  EXPECT_DOUBLE_EQ(score(Score::kWnccPaper, kPairs), 1200 / std::sqrt(1400.0 * 1000.0));
}

TEST(ReferenceScores, ZeroMeanByHand) {
  // Deviations -20, -10, 0, 30 and -10, -20, 20, 10: product 200 + 200 + 0 + 300.
  EXPECT_DOUBLE_EQ(score(Score::kZncc, kPairs), 700 / std::sqrt(1400.0 * 1000.0));
  // Weights 2, 1, 1, 2: means 190/6 and 180/6.
  const double mean = 190.0 / 6.0;
  const double product =
      2 * (10 - mean) * -10 + (20 - mean) * -20 + (30 - mean) * 20 + 2 * (60 - mean) * 10;
  const double map_norm = 2 * std::pow(10 - mean, 2) + std::pow(20 - mean, 2) +
                          std::pow(30 - mean, 2) + 2 * std::pow(60 - mean, 2);
  const double local_norm = 2 * 100 + 400 + 400 + 2 * 100;
  EXPECT_NEAR(score(Score::kZwncc, kPairs), product / std::sqrt(map_norm * local_norm), 1e-12);
}

TEST(ReferenceScores, UndefinedIsNaNAndNeverAZero) {
  for (const auto& [value, name] : kScoreNames) {
    EXPECT_TRUE(std::isnan(score(value, PixelPairs{}))) << name;
  }
  const PixelPairs flat{{50, 50, 50}, {10, 20, 30}, {1, 1, 1}};
  for (const Score value : {Score::kZncc, Score::kZwncc, Score::kWnccPaper}) {
    EXPECT_TRUE(std::isnan(score(value, flat))) << to_string(value);
  }
  const PixelPairs black{{0, 0, 0}, {10, 20, 30}, {1, 1, 1}};
  EXPECT_TRUE(std::isnan(score(Score::kNcc, black)));
}

// What is wrong with the paper's form, as measured: an exact copy scores above 1, and its sign is
// lost. zwncc has neither fault.
TEST(ReferenceScores, FaultsOfThePapersForm) {
  const PixelPairs copy{{10, 20, 30, 60}, {10, 20, 30, 60}, {2, 1, 1, 2}};
  EXPECT_GT(score(Score::kWncc, copy), 1.0);
  EXPECT_GT(score(Score::kWnccPaper, copy), 1.0);
  EXPECT_DOUBLE_EQ(score(Score::kZwncc, copy), 1.0);
  const PixelPairs negative{{10, 20, 30, 60}, {60, 50, 40, 10}, {1, 1, 1, 1}};
  EXPECT_DOUBLE_EQ(score(Score::kWnccPaper, negative), 1.0);
  EXPECT_DOUBLE_EQ(score(Score::kZwncc, negative), -1.0);
}

// Authors' fault "integer division turns the weight into a constant"; and [4] against its own text.
TEST(PixelWeight, NormalisedFallsFromTwoToOneAndLiteralGrowsOutwards) {
  const auto at = [](PaperWeight kind, double column, double row) {
    return pixel_weight(kind, {column, row}, 150, 150);
  };
  EXPECT_DOUBLE_EQ(at(PaperWeight::kNormalised, 75, 75), 2.0);
  EXPECT_DOUBLE_EQ(at(PaperWeight::kNormalised, 0, 0), 1.0);
  EXPECT_DOUBLE_EQ(at(PaperWeight::kNormalised, 37.5, 37.5), 1.75);
  EXPECT_DOUBLE_EQ(at(PaperWeight::kLiteral, 75, 75), 2.0);
  EXPECT_DOUBLE_EQ(at(PaperWeight::kLiteral, 0, 0), 5623.0);
}

}  // namespace
}  // namespace nadir
