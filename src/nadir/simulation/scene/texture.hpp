// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Linear colour as the square of eight bits: steps are fine where it is dark.
inline std::uint8_t encoded(float linear) {
  const float root = std::sqrt(std::clamp(linear, 0.0F, 1.0F));
  constexpr float kHalf = 0.5F;  // never negative: cutting off rounds
  return static_cast<std::uint8_t>(root * 255.0F + kHalf);
}

/// A picture of the ground with its reduced copies, for pixels of any size. Four channels of eight
/// bits a texel: red, green, blue encoded as above, the fourth as it is. Row 0 is SOUTH.
class Texture {
 public:
  Texture() = default;
  /// Texel (column, row) covers low + (column .. column + 1, row .. row + 1) texel_m.
  Texture(Raster<std::uint8_t> image, Eigen::Vector2d low, double texel_m, bool reduced);

  bool empty() const { return levels_.empty(); }
  /// Linear colour at a point for a pixel of width `footprint`, metres: trilinear.
  Eigen::Vector3f at(double x, double y, float footprint) const;
  /// Bilinear in the full image.
  Eigen::Vector4f finest(double x, double y) const { return bilinear(levels_.front(), x, y); }

 private:
  struct Level {
    Raster<std::uint8_t> image;
    double texel_m = 0.0;
  };
  Eigen::Vector4f bilinear(const Level& level, double x, double y) const;

  std::vector<Level> levels_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
};

}  // namespace nadir::simulation
