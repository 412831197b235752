// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Makes holes as a stereo elevation map has them - speckle, wedges in the shadow of obstacles,
/// blotches and a ragged outline - until `share` of all pixels is 0. `frame` picks the random
/// numbers.
void punch_holes(double share, std::uint64_t seed, int frame, Raster<std::uint8_t>& valid);

}  // namespace nadir::simulation
