// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/value_noise.hpp"

#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

constexpr std::uint64_t kNoiseStream = 90;
constexpr std::uint32_t kLayerRows = 0x5BDU;  ///< layers are the same rows, elsewhere
constexpr std::uint32_t kLayerColumns = 0x9E5U;
constexpr std::uint32_t kPlane = 0x2F3U;

/// The largest integer not above `value`; std::floor is a call without SSE 4.1.
std::int32_t floor_of(float value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - static_cast<std::int32_t>(value < static_cast<float>(truncated));
}

float ease(float t) { return t * t * (3.0F - 2.0F * t); }

}  // namespace

ValueNoise::ValueNoise(std::uint64_t seed) : values_(kSize), starts_(kSize) {
  const RandomStream random(seed, kNoiseStream);
  for (std::uint32_t i = 0; i < kSize; ++i) {
    const auto [value, start] = random.uniform_pair(i);
    values_[i] = static_cast<float>(2.0 * value - 1.0);
    starts_[i] = static_cast<std::uint16_t>(start * kSize);
  }
}

std::uint32_t ValueNoise::row_start(std::uint32_t row, std::uint32_t layer) const {
  return starts_[(row + layer * kLayerRows) & (kSize - 1U)] + layer * kLayerColumns;
}

float ValueNoise::at(float x, float y, float cell, std::uint32_t layer) const {
  const float scale = 1.0F / cell;
  const float u = x * scale;
  const float v = y * scale;
  const std::int32_t column = floor_of(u);
  const std::int32_t row = floor_of(v);
  const float a = ease(u - static_cast<float>(column));
  const float b = ease(v - static_cast<float>(row));
  const auto west = static_cast<std::uint32_t>(column);
  const std::uint32_t south = row_start(static_cast<std::uint32_t>(row), layer) + west;
  const std::uint32_t north = row_start(static_cast<std::uint32_t>(row) + 1U, layer) + west;
  const float below = value(south) + a * (value(south + 1U) - value(south));
  const float above = value(north) + a * (value(north + 1U) - value(north));
  return below + b * (above - below);
}

float ValueNoise::at(float x, float y, float z, float cell, std::uint32_t layer) const {
  const float w = z / cell;
  const std::int32_t plane = floor_of(w);
  const float c = ease(w - static_cast<float>(plane));
  const std::uint32_t low = layer + static_cast<std::uint32_t>(plane) * kPlane;
  return at(x, y, cell, low) * (1.0F - c) + at(x, y, cell, low + kPlane) * c;
}

float ValueNoise::fractal(float x, float y, float cell, int octaves, std::uint32_t layer,
                          float footprint, float fall) const {
  // Each octave is turned against the one before: the lattice of value noise does not add up.
  constexpr float kCos = 0.8F;
  constexpr float kSin = 0.6F;
  float sum = 0.0F;
  float total = 0.0F;
  float strength = 1.0F;
  for (int octave = 0; octave < octaves; ++octave) {
    const float seen = std::clamp(cell / footprint - 1.0F, 0.0F, 1.0F);
    if (seen > 0.0F) {
      sum += strength * seen * at(x, y, cell, layer * 16U + static_cast<std::uint32_t>(octave));
    }
    total += strength * strength;
    strength *= fall;
    cell *= 0.5F;
    const float turned = kCos * x - kSin * y;
    y = kSin * x + kCos * y;
    x = turned;
  }
  // The octaves are independent: their sum spreads as the root of their squares.
  return 1.25F * sum / (total > 1.0F ? total : 1.0F);
}

float ValueNoise::cell_value(std::int32_t column, std::int32_t row, std::uint32_t layer) const {
  return 0.5F + 0.5F * value(row_start(static_cast<std::uint32_t>(row), layer) +
                             static_cast<std::uint32_t>(column));
}

}  // namespace nadir::simulation
