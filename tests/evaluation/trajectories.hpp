// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "nadir/core/random.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir::testing {

inline Stamp at_second(double seconds) {
  return Stamp{static_cast<std::int64_t>(std::llround(seconds * 1e9))};
}

/// One pose a second, from second 0.
inline Trajectory each_second(const std::vector<Pose2>& poses) {
  Trajectory trajectory;
  for (const Pose2& pose : poses) {
    trajectory.push_back({at_second(static_cast<double>(trajectory.size())), pose});
  }
  return trajectory;
}

/// A seeded wander of `count` poses.
inline Trajectory random_walk(std::uint64_t seed, int count) {
  const RandomStream random(seed, 1);
  Pose2 pose{400.0, -200.0, 3.0};
  std::vector<Pose2> poses;
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(count); ++i) {
    const auto [forward, turn] = random.normal_pair(i);
    pose = pose * Motion2{1.0 + 0.3 * forward, 0.1 * forward, 0.4 * turn};
    poses.push_back(pose);
  }
  return each_second(poses);
}

/// `truth` with normal noise: `position_m` on x and y, `yaw_rad` on the heading.
inline Trajectory with_noise(const Trajectory& truth, std::uint64_t seed, double position_m,
                             double yaw_rad) {
  const RandomStream random(seed, 2);
  Trajectory noisy = truth;
  for (std::uint64_t i = 0; i < noisy.size(); ++i) {
    const auto [dx, dy] = random.normal_pair(2 * i);
    Pose2& pose = noisy[i].pose;
    pose.x += position_m * dx;
    pose.y += position_m * dy;
    pose.yaw = wrap_angle(pose.yaw + yaw_rad * random.normal(2 * i + 1));
  }
  return noisy;
}

}  // namespace nadir::testing
