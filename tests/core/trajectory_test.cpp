// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/trajectory.hpp"

#include <gtest/gtest.h>

namespace nadir {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;

/// One pose every `step_ms`, whose x is its stamp in milliseconds.
Trajectory every(std::int64_t step_ms, std::int64_t count) {
  Trajectory trajectory;
  for (std::int64_t k = 0; k < count; ++k) {
    trajectory.push_back(
        {Stamp{k * step_ms * kMillisecond}, Pose2{static_cast<double>(k * step_ms), 0.0, 0.0}});
  }
  return trajectory;
}

TEST(PoseAt, TakesTheNearestOfADenseTruth) {
  const Trajectory truth = every(5, 100);  // 200 Hz: five poses lie within 10 ms
  for (std::int64_t ms = 0; ms <= 495; ++ms) {
    const auto pose = pose_at(truth, Stamp{ms * kMillisecond});
    ASSERT_TRUE(pose) << ms;
    EXPECT_LE(std::abs(pose->x - static_cast<double>(ms)), 2.5) << ms;
  }
}

TEST(PoseAt, KnowsNoneBeyondTenMilliseconds) {
  const Trajectory truth = every(1000, 2);
  EXPECT_TRUE(pose_at(truth, Stamp{-10 * kMillisecond}));
  EXPECT_TRUE(pose_at(truth, Stamp{1010 * kMillisecond}));
  EXPECT_FALSE(pose_at(truth, Stamp{-11 * kMillisecond}));
  EXPECT_FALSE(pose_at(truth, Stamp{11 * kMillisecond}));
  EXPECT_FALSE(pose_at(truth, Stamp{989 * kMillisecond}));
  EXPECT_FALSE(pose_at(truth, Stamp{1011 * kMillisecond}));
  EXPECT_FALSE(pose_at({}, Stamp{}));
}

}  // namespace
}  // namespace nadir
