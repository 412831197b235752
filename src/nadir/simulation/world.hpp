// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/simulation/road.hpp"

namespace nadir::simulation {

/// A simulated place from straight above.
struct World {
  Road road;
  Raster<std::uint8_t> image;  ///< RGB, everything that is there, also outside the mosaic
  Raster<std::uint8_t> seen;   ///< 0 where the drone's mosaic ends: a ragged border
  GeoReference geo;            ///< map frame, 0.10 m per pixel, south-west corner at (0, 0)
};

/// Paints a place of about `length_m` x 60 m around a road from west to east.
World paint_world(std::uint64_t seed, double length_m);

}  // namespace nadir::simulation
