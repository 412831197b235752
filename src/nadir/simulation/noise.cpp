// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/noise.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

constexpr std::size_t kTableSize = 1U << 12U;

double ease(double t) { return t * t * (3.0 - 2.0 * t); }

/// Scrambles a lattice position, so that the table of random values is never read periodically.
std::uint32_t scramble(std::uint32_t h) {
  h ^= h >> 15U;
  h *= 0x2C1B3C6DU;
  return h ^ (h >> 14U);
}

/// The largest integer not above `value`; faster than std::floor without SSE 4.1.
std::int32_t floor_of(double value) {
  const auto truncated = static_cast<std::int32_t>(value);
  return truncated - static_cast<std::int32_t>(value < truncated);
}

}  // namespace

double smooth_step(double low, double high, double value) {
  return ease(std::clamp((value - low) / (high - low), 0.0, 1.0));
}

SmoothNoise::SmoothNoise(std::uint64_t seed, std::uint64_t stream) : values_(kTableSize) {
  const RandomStream random(seed, stream);
  for (std::size_t i = 0; i < kTableSize; ++i) values_[i] = static_cast<float>(random.uniform(i));
}

double SmoothNoise::at(double x, double y, double cell, std::uint32_t layer) const {
  constexpr std::uint32_t kColumnStep = 0x85EBCA6BU;
  constexpr std::uint32_t kRowStep = 0xC2B2AE35U;
  const double u = x / cell;
  const double v = y / cell;
  const std::int32_t column = floor_of(u);
  const std::int32_t row = floor_of(v);
  const double a = ease(u - column);
  const double b = ease(v - row);
  const std::uint32_t west = static_cast<std::uint32_t>(column) * kColumnStep + layer * 0x27D4EB2FU;
  const std::uint32_t south = static_cast<std::uint32_t>(row) * kRowStep;
  const double near = blend(west, south, west + kColumnStep, a);
  const double far = blend(west, south + kRowStep, west + kColumnStep, a);
  return (1.0 - b) * near + b * far;
}

double SmoothNoise::blend(std::uint32_t west, std::uint32_t row, std::uint32_t east,
                          double share) const {
  return (1.0 - share) * values_[scramble(west ^ row) & (kTableSize - 1)] +
         share * values_[scramble(east ^ row) & (kTableSize - 1)];
}

double SmoothNoise::fractal(double x, double y, double cell, int octaves,
                            std::uint32_t layer) const {
  double sum = 0.0;
  double strength = 1.0;
  double total = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    sum +=
        strength * (2.0 * at(x, y, cell, layer * 16U + static_cast<std::uint32_t>(octave)) - 1.0);
    total += strength;
    strength *= 0.5;
    cell *= 0.5;
  }
  return sum / total;
}

}  // namespace nadir::simulation
