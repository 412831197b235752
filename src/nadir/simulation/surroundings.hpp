// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/simulation/paint.hpp"

namespace nadir::simulation {

/// Paints what stands beside the road, with shadows away from the one sun: flat-roofed buildings
/// and trees.
void paint_surroundings(const Place& place, Painting& painting);

}  // namespace nadir::simulation
