// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

double median_of_sorted(std::span<const double> sorted) {
  const std::size_t middle = sorted.size() / 2;
  if (sorted.size() % 2 == 1) return sorted[middle];
  return 0.5 * (sorted[middle - 1] + sorted[middle]);
}

}  // namespace

Statistics statistics(std::span<const double> errors) {
  if (errors.empty()) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return {kNone, kNone, kNone, kNone, kNone, kNone, kNone};
  }
  if (!std::ranges::all_of(errors, [](double error) { return std::isfinite(error); })) {
    throw Error(ErrorKind::kProcessing, "an error to be averaged is not a finite number");
  }
  std::vector<double> sorted(errors.begin(), errors.end());
  std::ranges::sort(sorted);

  const auto count = static_cast<double>(sorted.size());
  double sum = 0.0;
  double sse = 0.0;
  for (const double error : sorted) {
    sum += error;
    sse += error * error;
  }
  const double mean = sum / count;
  double deviation = 0.0;
  for (const double error : sorted) deviation += (error - mean) * (error - mean);
  return {std::sqrt(sse / count),
          mean,
          median_of_sorted(sorted),
          std::sqrt(deviation / count),
          sorted.front(),
          sorted.back(),
          sse};
}

}  // namespace nadir
