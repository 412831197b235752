// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/road.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace nadir::simulation {
namespace {

TEST(Road, LocateIsTheInverseOfPlace) {
  const Road road(11, 120.0, 60.0);
  for (double along = 5.0; along < 120.0; along += 3.7) {
    for (const double across : {-9.0, -1.75, 0.0, 0.4, 6.0}) {
      const RoadPoint back = road.locate(road.place({along, across}));
      EXPECT_NEAR(back.along, along, 1e-3);
      EXPECT_NEAR(back.across, across, 1e-3);
    }
  }
}

TEST(Road, AlongIsLengthAndHeadingIsItsDirection) {
  const Road road(12, 120.0, 60.0);
  for (double along = 10.0; along < 110.0; along += 7.3) {
    const auto here = road.place({along, 0.0});
    const auto ahead = road.place({along + 0.5, 0.0});
    EXPECT_NEAR(std::hypot(ahead.x - here.x, ahead.y - here.y), 0.5, 1e-3);
    EXPECT_NEAR(std::atan2(ahead.y - here.y, ahead.x - here.x), road.heading(along + 0.25), 2e-3);
  }
}

TEST(Road, LeftIsPositive) {
  const Road road(13, 120.0, 60.0);
  EXPECT_GT(road.place({50.0, 2.0}).y, road.place({50.0, -2.0}).y);
}

}  // namespace
}  // namespace nadir::simulation
