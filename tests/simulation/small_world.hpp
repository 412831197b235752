// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <vector>

#include "nadir/simulation/simulated_world.hpp"

namespace nadir::test {

/// A campus that is small and coarse enough to be made many times.
inline WorldOptions small_world() {
  WorldOptions options;
  options.width_m = 90.0;
  options.depth_m = 70.0;
  options.margin_m = 5.0;
  options.texel_m = 0.10;
  return options;
}

inline const SimulatedWorld& campus() {
  static const SimulatedWorld kWorld = SimulatedWorld::make(3, small_world());
  return kWorld;
}

/// Zero-mean normalised cross-correlation of two columns of numbers.
inline double zncc(const std::vector<double>& a, const std::vector<double>& b) {
  double mean_a = 0.0;
  double mean_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    mean_a += a[i] / static_cast<double>(a.size());
    mean_b += b[i] / static_cast<double>(a.size());
  }
  double sum = 0.0;
  double sum_a = 0.0;
  double sum_b = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - mean_a) * (b[i] - mean_b);
    sum_a += (a[i] - mean_a) * (a[i] - mean_a);
    sum_b += (b[i] - mean_b) * (b[i] - mean_b);
  }
  return sum / std::sqrt(sum_a * sum_b);
}

}  // namespace nadir::test
