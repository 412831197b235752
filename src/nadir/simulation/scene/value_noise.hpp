// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

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

/// Smooth random texture (value noise), a pure function of seed, position and layer: equal at every
/// zoom and for any order of evaluation. A layer repeats after 4096 cells; a sum of turned octaves
/// repeats nowhere within a site.
class ValueNoise {
 public:
  explicit ValueNoise(std::uint64_t seed);

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
  static constexpr std::uint32_t kSize = 4096;
  std::uint32_t row_start(std::uint32_t row, std::uint32_t layer) const;
  float value(std::uint32_t index) const { return values_[index & (kSize - 1U)]; }

  std::vector<float> values_;          ///< in [-1, 1)
  std::vector<std::uint16_t> starts_;  ///< where in them a row of the lattice begins
};

}  // namespace nadir::simulation
