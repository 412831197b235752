// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string_view>
#include <vector>

#include "nadir/core/raster.hpp"

namespace nadir::aerial {

struct Feature {
  float u = 0.0F;  ///< pixels, (0, 0) = centre of the first pixel
  float v = 0.0F;
  float size = 0.0F;  ///< diameter, pixels
};

/// The features of a photo, the largest first.
struct PhotoFeatures {
  std::vector<Feature> points;
  cv::Mat descriptors;  ///< one row a feature: RootSIFT, 128 x float
  /// Detail of 4 pixels over detail of 8: what blur takes away, and what does not depend much on
  /// what the photo shows. To be compared between photos of one flight.
  double sharpness = 0.0;
};

/// SIFT features (Lowe 2004), at most `limit`, spread over the image, with RootSIFT descriptors
/// (Arandjelovic and Zisserman 2012).
PhotoFeatures find_features(const Raster<std::uint8_t>& image, int limit);

/// Bytes that find_features needs at its peak for an image of this size.
std::size_t feature_memory(int width, int height);

/// A seed that is a pure function of a name (FNV-1a).
std::uint64_t seed_of(std::string_view name);

}  // namespace nadir::aerial
