// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/simulation/paint.hpp"

namespace nadir::simulation {

/// Paints what lies on the carriageway: cracks, worn lane markings, zebra crossings with their stop
/// lines, arrows, manhole covers and drains.
void paint_carriageway(const Place& place, Painting& painting);

}  // namespace nadir::simulation
