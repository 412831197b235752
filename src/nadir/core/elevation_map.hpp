// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/geo_reference.hpp"
#include "nadir/core/raster.hpp"

namespace nadir {

/// Heights seen from straight above: the drone's surface model, or the surroundings of the ground
/// robot. Metres above the owner's datum; NaN = unknown, and nothing else says so.
struct ElevationMap {
  Raster<float> height_m;  ///< 1 channel
  GeoReference geo;

  int width() const { return height_m.width(); }
  int height() const { return height_m.height(); }
};

}  // namespace nadir
