// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/value_noise.hpp"

namespace nadir::simulation {
namespace {

constexpr std::uint32_t kColumnStep = 0x85EBCA6BU;
constexpr std::uint32_t kRowStep = 0xC2B2AE35U;
constexpr std::uint32_t kPlaneStep = 0x27D4EB2FU;
constexpr std::uint32_t kLayerStep = 0x165667B1U;

/// The largest integer not above `value`; std::floor is a call without SSE 4.1.
std::int32_t floor_of(float value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - static_cast<std::int32_t>(value < static_cast<float>(truncated));
}

float signed_value(std::uint32_t h) {
  return static_cast<float>(static_cast<std::int32_t>(scrambled(h))) * 0x1.0p-31F;
}

float ease(float t) { return t * t * (3.0F - 2.0F * t); }

}  // namespace

float ValueNoise::at(float x, float y, float cell, std::uint32_t layer) const {
  const float u = x / cell;
  const float v = y / cell;
  const std::int32_t column = floor_of(u);
  const std::int32_t row = floor_of(v);
  const float a = ease(u - static_cast<float>(column));
  const float b = ease(v - static_cast<float>(row));
  const std::uint32_t west = static_cast<std::uint32_t>(column) * kColumnStep;
  const std::uint32_t south =
      (static_cast<std::uint32_t>(row) * kRowStep) ^ (key_ + layer * kLayerStep);
  const std::uint32_t north =
      ((static_cast<std::uint32_t>(row) + 1U) * kRowStep) ^ (key_ + layer * kLayerStep);
  const float below =
      signed_value(west + south) * (1.0F - a) + signed_value(west + kColumnStep + south) * a;
  const float above =
      signed_value(west + north) * (1.0F - a) + signed_value(west + kColumnStep + north) * a;
  return below * (1.0F - b) + above * b;
}

float ValueNoise::at(float x, float y, float z, float cell, std::uint32_t layer) const {
  const float w = z / cell;
  const std::int32_t plane = floor_of(w);
  const float c = ease(w - static_cast<float>(plane));
  const std::uint32_t low = layer + static_cast<std::uint32_t>(plane) * kPlaneStep;
  return at(x, y, cell, low) * (1.0F - c) + at(x, y, cell, low + kPlaneStep) * c;
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
  const std::uint32_t h =
      static_cast<std::uint32_t>(column) * kColumnStep +
      ((static_cast<std::uint32_t>(row) * kRowStep) ^ (key_ + layer * kLayerStep));
  return static_cast<float>(scrambled(h) >> 8U) * 0x1.0p-24F;
}

}  // namespace nadir::simulation
