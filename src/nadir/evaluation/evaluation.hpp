// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

/// evo's words. All zero for an empty sample.
struct Statistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;
  double std = 0.0;
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;
};
Statistics statistics(std::span<const double> errors);

}  // namespace nadir
