// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace nadir::simulation {

/// The independent sources of randomness of a simulated site. Each draws from its own stream, so
/// that a change of one leaves all others as they were.
enum class Source : std::uint64_t {
  kTexture = 1,
  kRoad,
  kPatches,
  kCracks,
  kFurniture,
  kTrees,
  kBuildings,
  kBorder,
  kCars,
  kPath,
  kOdometry,
  kHoles = 1000,           ///< plus the number of the frame
  kSensorNoise = 1000000,  ///< plus the number of the frame
};

constexpr std::uint64_t stream_of(Source source, int frame = 0) {
  return static_cast<std::uint64_t>(source) + static_cast<std::uint64_t>(frame);
}

/// 0 below `low`, 1 above `high`, smooth between.
double smooth_step(double low, double high, double value);

/// Smooth random texture of the plane (value noise): a pure function of seed and position that
/// repeats nowhere within a site.
class SmoothNoise {
 public:
  SmoothNoise(std::uint64_t seed, std::uint64_t stream);

  /// In [0, 1), with features of about `cell` (same unit as x and y). `layer` picks one of many
  /// independent textures.
  double at(double x, double y, double cell, std::uint32_t layer = 0) const;
  /// Sum of octaves from `cell` down, each half as large and half as strong; in [-1, 1], mean 0.
  double fractal(double x, double y, double cell, int octaves, std::uint32_t layer = 0) const;

 private:
  double blend(std::uint32_t west, std::uint32_t row, std::uint32_t east, double share) const;

  std::vector<float> values_;
};

}  // namespace nadir::simulation
