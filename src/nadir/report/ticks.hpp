// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace nadir::report {

/// The number 1, 2 or 5 times a power of ten that is nearest below or at `value` (> 0).
double round_down(double value);

/// Step of 1, 2 or 5 times a power of ten that cuts `span` (> 0) into at most `most` pieces.
double nice_step(double span, int most);

/// The multiples of `step` in [low, high].
std::vector<double> ticks_between(double low, double high, double step);

/// A tick's label with just the decimals that `step` needs.
std::string tick_label(double value, double step);

}  // namespace nadir::report
