// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/ticks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace nadir::report {

double round_down(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value) + 1e-9));
  const double mantissa = value / power + 1e-9;
  return power * (mantissa >= 5.0 ? 5.0 : mantissa >= 2.0 ? 2.0 : 1.0);
}

double nice_step(double span, int most) {
  const double least = span / most;
  const double below = round_down(least);
  if (below >= least * (1.0 - 1e-9)) return below;
  return round_down(2.51 * below);  // the next of 1, 2, 5, 10
}

std::vector<double> ticks_between(double low, double high, double step) {
  std::vector<double> ticks;
  const double slack = 1e-9 * std::max(std::abs(low), std::abs(high)) + 1e-6 * step;
  for (double n = std::ceil((low - slack) / step); n * step <= high + slack; n += 1.0) {
    ticks.push_back(n == 0.0 ? 0.0 : n * step);
  }
  return ticks;
}

std::string tick_label(double value, double step) {
  const int decimals = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, value);
  return text.data();
}

}  // namespace nadir::report
