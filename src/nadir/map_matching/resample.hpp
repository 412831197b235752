// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/geo_reference.hpp"
#include "nadir/core/raster.hpp"

namespace nadir {

/// Grey values with validity, in floating point: what lies between an orthomosaic and a channel.
struct GreyImage {
  Raster<float> value;         ///< 0 .. 255; 0 where invalid
  Raster<std::uint8_t> valid;  ///< 1 = seen, 0 = hole
  GeoReference geo;
};

/// Area average of the valid pixels on square cells of `resolution` metres, whose grid shares the
/// upper-left outer corner of the input. A cell is valid where at least half of its area inside the
/// input is. Finer cells than the input's are interpolated from the nearest pixel (area of one).
GreyImage resample(const GreyImage& image, double resolution);

}  // namespace nadir
