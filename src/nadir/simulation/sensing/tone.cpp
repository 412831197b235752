// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/sensing/tone.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

constexpr float kExposure = 1.55F;
constexpr int kToneSteps = 2048;
constexpr float kBrightest = 2.0F;  ///< radiance; white beyond

/// The curve is tabulated over the square root, in which it is nearly straight.
const std::array<float, kToneSteps + 1>& tone_table() {
  static const std::array<float, kToneSteps + 1> values = [] {
    std::array<float, kToneSteps + 1> table{};
    for (int i = 0; i <= kToneSteps; ++i) {
      const float root = static_cast<float>(i) / kToneSteps;
      const float exposed = kExposure * kBrightest * root * root;
      // Straight gamma up to the shoulder, which reaches white at the brightest radiance.
      const float value = std::pow(exposed, 1.0F / 2.2F);
      table[static_cast<std::size_t>(i)] =
          255.0F * (value < 0.8F ? value : 1.0F - 0.2F * std::exp(-(value - 0.8F) / 0.2F));
    }
    return table;
  }();
  return values;
}

/// Gaussian weights of one side, the middle first.
std::vector<float> kernel_of(float sigma) {
  std::vector<float> weights;
  const int radius = std::max(1, static_cast<int>(std::ceil(2.5F * sigma)));
  float sum = 0.0F;
  for (int i = 0; i <= radius; ++i) {
    const float x = static_cast<float>(i) / sigma;
    weights.push_back(std::exp(-0.5F * x * x));
    sum += (i == 0 ? 1.0F : 2.0F) * weights.back();
  }
  for (float& weight : weights) weight /= sum;
  return weights;
}

Raster<float> blurred(const Raster<float>& image, float sigma) {
  const std::vector<float> kernel = kernel_of(sigma);
  const int radius = static_cast<int>(kernel.size()) - 1;
  const int channels = image.channels();
  Raster<float> across(image.width(), image.height(), 0.0F, channels);
  tbb::parallel_for(0, image.height(), [&](int row) {
    for (int column = 0; column < image.width(); ++column) {
      for (int i = -radius; i <= radius; ++i) {
        const int c = std::clamp(column + i, 0, image.width() - 1);
        const float weight = kernel[static_cast<std::size_t>(std::abs(i))];
        for (int k = 0; k < channels; ++k) {
          across.at(column, row, k) += weight * image.at(c, row, k);
        }
      }
    }
  });
  Raster<float> result(image.width(), image.height(), 0.0F, channels);
  tbb::parallel_for(0, image.height(), [&](int row) {
    const auto to = result.row(row);
    for (int i = -radius; i <= radius; ++i) {
      const auto from = across.row(std::clamp(row + i, 0, image.height() - 1));
      const float weight = kernel[static_cast<std::size_t>(std::abs(i))];
      for (std::size_t k = 0; k < to.size(); ++k) to[k] += weight * from[k];
    }
  });
  return result;
}

/// Three nearly normal numbers from one block of random bits: sums of four bytes each.
std::array<float, 3> noise_at(std::uint64_t seed, std::uint64_t stream, std::uint64_t index) {
  const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const auto high = [](std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32U); };
  const auto words =
      philox4x32({low(index), high(index), low(stream), high(stream)}, {low(seed), high(seed)});
  std::array<float, 3> normal{};
  for (std::size_t i = 0; i < 3; ++i) {
    std::uint32_t sum = 0;
    for (std::uint32_t shift = 0; shift < 32; shift += 8) sum += (words[i] >> shift) & 0xFFU;
    normal[i] =
        (static_cast<float>(sum) - 510.0F) * (1.0F / 147.8F);  // variance 4 (256^2 - 1) / 12
  }
  return normal;
}

std::uint8_t rounded(float value) {
  constexpr float kHalf = 0.5F;  // never negative: cutting off rounds
  return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + kHalf);
}

}  // namespace

float display_value(float radiance) {
  const float place = std::sqrt(std::clamp(radiance / kBrightest, 0.0F, 1.0F)) * kToneSteps;
  const auto below = std::min(static_cast<std::size_t>(place), std::size_t{kToneSteps - 1});
  const float share = place - static_cast<float>(below);
  const auto& table = tone_table();
  return table[below] + share * (table[below + 1] - table[below]);
}

Raster<std::uint8_t> display(const Raster<float>& linear) {
  Raster<std::uint8_t> image(linear.width(), linear.height(), 0, linear.channels());
  std::transform(linear.values().begin(), linear.values().end(), image.values().begin(),
                 [](float radiance) { return rounded(display_value(radiance)); });
  return image;
}

Raster<std::uint8_t> develop(const Raster<float>& linear, const Development& development) {
  const Raster<float> sharp =
      development.blur_px > 0.05F ? blurred(linear, development.blur_px) : linear;
  const int width = linear.width();
  const int height = linear.height();
  Raster<std::uint8_t> image(width, height, 0, development.grey ? 1 : 3);
  const float half_diagonal =
      0.5F * std::hypot(static_cast<float>(width), static_cast<float>(height));
  tbb::parallel_for(0, height, [&](int row) {
    const float y =
        (static_cast<float>(row) + 0.5F - 0.5F * static_cast<float>(height)) / half_diagonal;
    for (int column = 0; column < width; ++column) {
      const float x =
          (static_cast<float>(column) + 0.5F - 0.5F * static_cast<float>(width)) / half_diagonal;
      const float r2 = x * x + y * y;
      const float lens = 1.0F - development.vignetting * r2 * (0.4F + 0.6F * r2);
      std::array<float, 3> noise{};
      if (development.noise_grey > 0.0F) {
        noise = noise_at(development.seed, development.stream,
                         static_cast<std::uint64_t>(row) * static_cast<std::uint64_t>(width) +
                             static_cast<std::uint64_t>(column));
      }
      std::array<float, 3> value{};
      for (int k = 0; k < 3; ++k) {
        value[static_cast<std::size_t>(k)] =
            display_value(sharp.at(column, row, k) * lens * development.gain[k]);
      }
      if (development.grey) {
        const float level = 0.299F * value[0] + 0.587F * value[1] + 0.114F * value[2];
        image.at(column, row) = rounded(level + development.noise_grey * noise[0]);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        image.at(column, row, static_cast<int>(k)) =
            rounded(value[k] + development.noise_grey * noise[k]);
      }
    }
  });
  return image;
}

}  // namespace nadir::simulation
