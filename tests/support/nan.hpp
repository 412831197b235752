// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>

namespace nadir::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace nadir::test
