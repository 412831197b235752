// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace nadir {

inline constexpr double kPi = std::numbers::pi;

constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }
constexpr double degrees(double radians) { return radians * (180.0 / kPi); }

/// The same angle in (-pi, pi].
inline double wrap_angle(double angle_rad) {
  const double wrapped = std::remainder(angle_rad, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// The yaw (0 = east, counter-clockwise) of a heading (0 = north, clockwise), radians. The heading
/// must be that of the frame's north: one from true north loses the grid convergence first
/// (MetricFrame::yaw_of_true_heading).
inline double yaw_of_heading(double heading_rad) { return wrap_angle(0.5 * kPi - heading_rad); }

}  // namespace nadir
