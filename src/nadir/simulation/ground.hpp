// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/simulation/paint.hpp"

namespace nadir::simulation {

/// Paints the bare ground over the whole canvas: grass, a gravel path, paved footways, kerbs and
/// the worn asphalt of the carriageway.
void paint_ground(const Place& place, Painting& painting);

}  // namespace nadir::simulation
