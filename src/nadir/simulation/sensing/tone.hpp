// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir::simulation {

/// Brings linear radiance (white in the sun = 1) to grey levels 0 .. 255, as a camera's gamma does;
/// smooth up to the white of the sensor.
float display_value(float radiance);

/// The same, rounded, for a whole image of linear RGB.
Raster<std::uint8_t> display(const Raster<float>& linear);

/// What a sensor and its lens do to an image, besides geometry.
struct Development {
  Eigen::Vector3f gain = Eigen::Vector3f::Ones();  ///< exposure and white balance
  float vignetting = 0.0F;                         ///< loss in the corners, share
  float blur_px = 0.0F;                            ///< standard deviation
  float noise_grey = 0.0F;                         ///< standard deviation at mid grey, of 255
  bool grey = false;                               ///< one channel
  std::uint64_t seed = 0;
  std::uint64_t stream = 0;
};

Raster<std::uint8_t> develop(const Raster<float>& linear, const Development& development);

}  // namespace nadir::simulation
