// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir {

/// The 2 x 2 neighbourhood of every pixel in one word, so that bilinear sampling is one gather:
/// pixel (u, v), (u+1, v), (u, v+1), (u+1, v+1) from the lowest byte up; 0 where one of the four is
/// a hole or outside. Element (u + kMargin, v + kMargin) belongs to pixel (u, v); the margin is all
/// 0, so that an index clamped to the raster is a hole too.
struct Quads {
  static constexpr int kMargin = 2;
  Raster<std::uint32_t> words;
};

/// `value` must be at least 1 where `valid` is set.
Quads pack_quads(const Raster<std::uint8_t>& value, const Raster<std::uint8_t>& valid);

}  // namespace nadir
