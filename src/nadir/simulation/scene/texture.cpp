// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/texture.hpp"

#include <cstddef>
#include <utility>

namespace nadir::simulation {
namespace {

constexpr int kChannels = 4;
constexpr int kSmallest = 8;

float decoded(std::uint8_t code) {
  const float root = static_cast<float>(code) * (1.0F / 255.0F);
  return root * root;
}

/// Mean of 2 x 2 texels, in linear light.
Raster<std::uint8_t> halved(const Raster<std::uint8_t>& image) {
  Raster<std::uint8_t> half(image.width() / 2, image.height() / 2, 0, kChannels);
  for (int row = 0; row < half.height(); ++row) {
    for (int column = 0; column < half.width(); ++column) {
      for (int channel = 0; channel < kChannels; ++channel) {
        float sum = 0.0F;
        for (int i = 0; i < 4; ++i) {
          sum += decoded(image.at(2 * column + (i & 1), 2 * row + (i >> 1), channel));
        }
        half.at(column, row, channel) = encoded(0.25F * sum);
      }
    }
  }
  return half;
}

}  // namespace

Texture::Texture(Raster<std::uint8_t> image, Eigen::Vector2d low, double texel_m, bool reduced)
    : low_(std::move(low)) {
  levels_.push_back({std::move(image), texel_m});
  while (reduced &&
         std::min(levels_.back().image.width(), levels_.back().image.height()) >= 2 * kSmallest) {
    levels_.push_back({halved(levels_.back().image), 2.0 * levels_.back().texel_m});
  }
}

Eigen::Vector4f Texture::bilinear(const Level& level, double x, double y) const {
  const Raster<std::uint8_t>& image = level.image;
  const double u = std::clamp((x - low_.x()) / level.texel_m - 0.5, 0.0, image.width() - 1.001);
  const double v = std::clamp((y - low_.y()) / level.texel_m - 0.5, 0.0, image.height() - 1.001);
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const auto a = static_cast<float>(u - column);
  const auto b = static_cast<float>(v - row);
  const std::uint8_t* south = &image.at(column, row);
  const std::uint8_t* north = south + static_cast<std::ptrdiff_t>(image.width()) * kChannels;
  // Interpolated in encoded values: between neighbours the difference to linear light is small.
  Eigen::Vector4f root;
  for (int channel = 0; channel < kChannels; ++channel) {
    const auto sw = static_cast<float>(south[channel]);
    const auto se = static_cast<float>(south[channel + kChannels]);
    const auto nw = static_cast<float>(north[channel]);
    const auto ne = static_cast<float>(north[channel + kChannels]);
    const float below = sw + a * (se - sw);
    const float above = nw + a * (ne - nw);
    root[channel] = (below + b * (above - below)) * (1.0F / 255.0F);
  }
  return root.cwiseProduct(root);
}

Eigen::Vector3f Texture::at(double x, double y, float footprint) const {
  const float level = std::clamp(std::log2(footprint / static_cast<float>(levels_[0].texel_m)),
                                 0.0F, static_cast<float>(levels_.size() - 1));
  const auto below = static_cast<std::size_t>(level);
  const float share = level - static_cast<float>(below);
  const Eigen::Vector4f fine = bilinear(levels_[below], x, y);
  if (share < 0.02F || below + 1 >= levels_.size()) return fine.head<3>();
  const Eigen::Vector4f coarse = bilinear(levels_[below + 1], x, y);
  return (fine + share * (coarse - fine)).head<3>();
}

}  // namespace nadir::simulation
