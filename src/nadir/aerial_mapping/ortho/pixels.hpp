// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/raster.hpp"

namespace nadir::aerial {

/// Pixels of a photo, checked against its camera. Throws Error (input).
Raster<std::uint8_t> load_checked(const PhotoSet& set, std::size_t photo);

/// The same as an RGB image; grey photos get three equal channels.
cv::Mat rgb_of(const PhotoSet& set, std::size_t photo);

}  // namespace nadir::aerial
