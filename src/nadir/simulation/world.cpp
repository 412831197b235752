// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/world.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/ground.hpp"
#include "nadir/simulation/markings.hpp"
#include "nadir/simulation/surroundings.hpp"

namespace nadir::simulation {
namespace {

constexpr double kWidth = 60.0;
constexpr double kResolution = 0.10;
constexpr int kOversampling = 2;
constexpr std::uint32_t kBorderLayer = 80;

/// Averages the fine canvas down to the orthomosaic's pixels.
Raster<std::uint8_t> develop(Painting& painting) {
  Raster<float>& fine = painting.image;
  const int width = fine.width() / kOversampling;
  const int height = fine.height() / kOversampling;
  const cv::Mat source(fine.height(), fine.width(), CV_32FC3, fine.values().data());
  cv::Mat averaged;
  cv::resize(source, averaged, {width, height}, 0.0, 0.0, cv::INTER_AREA);
  Raster<std::uint8_t> image(width, height, 0, 3);
  cv::Mat target(height, width, CV_8UC3, image.values().data());
  averaged.convertTo(target, CV_8UC3);
  return image;
}

/// The mosaic's outline: the union of photo edges, so straight steps with a little fray.
Raster<std::uint8_t> ragged_outline(const Place& place, int width, int height) {
  Raster<std::uint8_t> seen(width, height, 255);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = (column + 0.5) * kResolution;
      const double y = (height - row - 0.5) * kResolution;
      const double inside =
          std::min(std::min(x, place.length_m - x), std::min(y, place.width_m - y));
      if (inside > 4.5) continue;
      const double step =
          place.noise.at(std::floor(x / 9.1), std::floor(y / 9.1), 1.0, kBorderLayer);
      const double fray = place.noise.fractal(x, y, 2.5, 5, kBorderLayer + 1);
      if (inside < 0.35 + 2.8 * step * step + 0.5 * std::abs(fray)) seen.at(column, row) = 0;
    }
  }
  return seen;
}

}  // namespace

World paint_world(std::uint64_t seed, double length_m) {
  const int width = static_cast<int>(std::lround(length_m / kResolution));
  const int height = static_cast<int>(std::lround(kWidth / kResolution));
  const Place place{seed,
                    length_m,
                    kWidth,
                    Road(seed, length_m, kWidth),
                    SmoothNoise(seed, stream_of(Source::kTexture)),
                    RandomStream(seed, stream_of(Source::kBorder)).uniform(0, 0.0, 2.0 * kPi)};
  Painting painting{Raster<float>(width * kOversampling, height * kOversampling, 0.0F, 3),
                    {0.0, kWidth, kResolution / kOversampling, {}}};
  paint_ground(place, painting);
  paint_carriageway(place, painting);
  paint_surroundings(place, painting);
  return {place.road,
          develop(painting),
          ragged_outline(place, width, height),
          {0.0, kWidth, kResolution, {}}};
}

}  // namespace nadir::simulation
