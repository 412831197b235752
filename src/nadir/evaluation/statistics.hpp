// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

namespace nadir {

/// evo's words. All NaN for an empty sample.
struct Statistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;  ///< of the population, as NumPy's and evo's
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;
};

/// Throws Error (processing) for an error that is not finite.
Statistics statistics(std::span<const double> errors);

}  // namespace nadir
