// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir {

/// The sheet of docs/simulation.md: a drone photo, the true orthomosaic, a stereo pair and a true
/// local map of the campus of seed 7. RGB.
Raster<std::uint8_t> draw_simulated_world_sheet();

}  // namespace nadir
