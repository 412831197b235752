// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "nadir/core/raster.hpp"

namespace nadir {

/// The pixels as OpenCV takes them, not copied.
inline cv::Mat view_of(Raster<std::uint8_t>& image) {
  return {image.height(), image.width(), CV_8UC(image.channels()), image.values().data()};
}

}  // namespace nadir
