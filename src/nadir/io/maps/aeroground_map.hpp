// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/core/raster.hpp"

namespace nadir {

/// One channel where the three channels of a grey JPEG are equal; otherwise the image as it is.
Raster<std::uint8_t> without_equal_channels(Raster<std::uint8_t> image);

/// 255 where the drone saw something. The data set marks the unseen by black, which JPEG blurs;
/// dark asphalt is black here and there too. So black is unseen only in regions that touch the
/// border of the image or are larger than a shadow's core, and two pixels around those.
Raster<std::uint8_t> seen_by_drone(const Raster<std::uint8_t>& image);

/// 255 where the robot saw something: a hole is white, blurred by JPEG.
Raster<std::uint8_t> seen_by_robot(const Raster<std::uint8_t>& image);

}  // namespace nadir
