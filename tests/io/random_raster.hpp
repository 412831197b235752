// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/random.hpp"

namespace nadir::test {

inline Raster<std::uint8_t> random_raster(int width, int height, int channels, std::uint64_t seed) {
  const RandomStream random(seed, 1);
  Raster<std::uint8_t> raster(width, height, 0, channels);
  for (std::size_t i = 0; i < raster.values().size(); ++i) {
    raster.values()[i] = static_cast<std::uint8_t>(random.uniform(i, 0.0, 256.0));
  }
  return raster;
}

/// Random colours, a third of the pixels holes, somewhere at UTM scale.
inline Orthomosaic random_orthomosaic(int width, int height, int channels, std::uint64_t seed) {
  const RandomStream random(seed, 2);
  Orthomosaic result{random_raster(width, height, channels, seed), {width, height, 255}, {}};
  for (std::size_t i = 0; i < result.valid.values().size(); ++i) {
    if (random.uniform(i) < 1.0 / 3.0) result.valid.values()[i] = 0;
  }
  const RandomStream place(seed, 3);
  result.geo = {
      place.uniform(0, -6e5, 6e5), place.uniform(1, -5e6, 5e6), place.uniform(2, 0.01, 0.3), {}};
  return result;
}

}  // namespace nadir::test
