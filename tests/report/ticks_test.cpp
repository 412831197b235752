// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/ticks.hpp"

#include <gtest/gtest.h>

namespace nadir::report {
namespace {

TEST(Ticks, RoundDownGivesOneTwoFive) {
  EXPECT_DOUBLE_EQ(round_down(1.0), 1.0);
  EXPECT_DOUBLE_EQ(round_down(4.9), 2.0);
  EXPECT_DOUBLE_EQ(round_down(99.0), 50.0);
  EXPECT_DOUBLE_EQ(round_down(0.1), 0.1);
  EXPECT_DOUBLE_EQ(round_down(0.03), 0.02);
}

TEST(Ticks, StepNeverGivesMoreThanAsked) {
  for (const double span : {0.013, 0.7, 1.0, 3.3, 47.0, 1e6}) {
    for (const int most : {1, 2, 4, 7, 12}) {
      const double step = nice_step(span, most);
      EXPECT_LE(span / step, most + 1e-6);
      EXPECT_GT(span / step, most / 2.6);
      EXPECT_DOUBLE_EQ(round_down(step), step);
    }
  }
}

TEST(Ticks, MultiplesWithBothEnds) {
  const std::vector<double> ticks = ticks_between(-0.2, 0.3, 0.1);
  ASSERT_EQ(ticks.size(), 6U);
  EXPECT_NEAR(ticks.front(), -0.2, 1e-12);
  EXPECT_EQ(ticks[2], 0.0);
  EXPECT_NEAR(ticks.back(), 0.3, 1e-12);
}

TEST(Ticks, LabelsHaveTheDecimalsOfTheStep) {
  EXPECT_EQ(tick_label(0.5, 0.5), "0.5");
  EXPECT_EQ(tick_label(1.0, 0.25), "1.0");
  EXPECT_EQ(tick_label(0.02, 0.02), "0.02");
  EXPECT_EQ(tick_label(20.0, 10.0), "20");
  EXPECT_EQ(tick_label(512340.0, 20.0), "512340");
}

}  // namespace
}  // namespace nadir::report
