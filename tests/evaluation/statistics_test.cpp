// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/statistics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

TEST(StatisticsTest, HandWorkedCase) {
  const Statistics s = statistics(std::vector<double>{4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.sse, 30.0);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
}

TEST(StatisticsTest, MedianOfAnOddCountIsTheMiddleOne) {
  EXPECT_DOUBLE_EQ(statistics(std::vector<double>{9.0, 1.0, 2.0}).median, 2.0);
  EXPECT_DOUBLE_EQ(statistics(std::vector<double>{7.0}).median, 7.0);
}

TEST(StatisticsTest, EmptyIsNoNumberAndNotFiniteIsRefused) {
  EXPECT_TRUE(std::isnan(statistics({}).rmse));
  EXPECT_THROW(statistics(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN()}),
               Error);
}

}  // namespace
}  // namespace nadir
