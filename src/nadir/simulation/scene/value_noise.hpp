// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

namespace nadir::simulation {

/// 0 below `low`, 1 above `high`, smooth between.
inline float ease_between(float low, float high, float value) {
  const float t = std::clamp((value - low) / (high - low), 0.0F, 1.0F);
  return t * t * (3.0F - 2.0F * t);
}

/// How much of a strip from `low` to `high` is seen at `value` by a pixel of half width `soft`.
inline float strip_share(float value, float low, float high, float soft) {
  return ease_between(low - soft, low + soft, value) *
         (1.0F - ease_between(high - soft, high + soft, value));
}

inline std::uint32_t scrambled(std::uint32_t h) {
  h ^= h >> 16U;
  h *= 0x7FEB352DU;
  h ^= h >> 15U;
  h *= 0x846CA68BU;
  return h ^ (h >> 16U);
}

/// Smooth random texture (value noise), a pure function of seed, position and layer: equal at every
/// zoom and for any order of evaluation, and never repeating within a site.
class ValueNoise {
 public:
  explicit ValueNoise(std::uint64_t seed)
      : key_(scrambled(static_cast<std::uint32_t>(seed) ^ 0x9E3779B9U) ^
             scrambled(static_cast<std::uint32_t>(seed >> 32U))) {}

  /// In [-1, 1], mean 0, with features of the size of `cell` (unit of x and y).
  float at(float x, float y, float cell, std::uint32_t layer) const;
  float at(float x, float y, float z, float cell, std::uint32_t layer) const;
  /// Sum of octaves from `cell` down, each half as large and `fall` as strong; octaves that a pixel
  /// of width `footprint` cannot show fade out. About within [-1, 1].
  float fractal(float x, float y, float cell, int octaves, std::uint32_t layer, float footprint,
                float fall = 0.5F) const;
  /// A constant random number in [0, 1) for a lattice cell.
  float cell_value(std::int32_t column, std::int32_t row, std::uint32_t layer) const;

 private:
  std::uint32_t key_;
};

}  // namespace nadir::simulation
