// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/random.hpp"

namespace nadir::test {

/// A smooth random texture: the sum of a few plane waves, defined at every point of the map, so
/// that any two images of it agree exactly where they overlap. Values in 20 .. 230.
class Texture {
 public:
  explicit Texture(std::uint64_t seed) : random_(seed, 17) {}
  double operator()(double x, double y) const {
    double sum = 0.0;
    for (std::uint64_t wave = 0; wave < kWaves; ++wave) {
      const double length_m = random_.uniform(4 * wave, 0.8, 5.0);
      const double direction = random_.uniform(4 * wave + 1, 0.0, 2.0 * kPi);
      const double phase = random_.uniform(4 * wave + 2, 0.0, 2.0 * kPi);
      const double along = x * std::cos(direction) + y * std::sin(direction);
      sum += std::sin(2.0 * kPi * along / length_m + phase);
    }
    return std::clamp(125.0 + 25.0 * sum, 20.0, 230.0);
  }

 private:
  static constexpr std::uint64_t kWaves = 12;
  RandomStream random_;
};

/// `texture` seen from above on the pixels of `geo`, through the pose of `geo`'s frame in the map.
inline Orthomosaic render(const Texture& texture, int width, int height, const GeoReference& geo,
                          const Pose2& map_from_frame) {
  Orthomosaic image{Raster<std::uint8_t>(width, height),
                    Raster<std::uint8_t>(width, height, std::uint8_t{1}), geo};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto point =
          map_from_frame * Point2<frames::Robot>{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      image.image.at(column, row) =
          static_cast<std::uint8_t>(std::lround(texture(point.x, point.y)));
    }
  }
  return image;
}

/// An unrelated image: every pixel a random grey, holes with probability `hole_share`.
inline Orthomosaic random_image(std::uint64_t seed, int width, int height, double hole_share,
                                const GeoReference& geo) {
  const RandomStream random(seed, 23);
  Orthomosaic image{Raster<std::uint8_t>(width, height), Raster<std::uint8_t>(width, height), geo};
  for (std::size_t i = 0; i < image.image.values().size(); ++i) {
    const auto [grey, hole] = random.uniform_pair(i);
    image.image.values()[i] = static_cast<std::uint8_t>(grey * 256.0);
    image.valid.values()[i] = hole < hole_share ? 0 : 255;
  }
  return image;
}

/// Punches random holes.
inline void punch_holes(Orthomosaic& image, std::uint64_t seed, double share) {
  const RandomStream random(seed, 29);
  for (std::size_t i = 0; i < image.valid.values().size(); ++i) {
    if (random.uniform(i) < share) image.valid.values()[i] = 0;
  }
}

/// A local map's geo-reference with the robot in its centre.
inline GeoReference centred(int width, int height, double resolution) {
  return {-0.5 * width * resolution, 0.5 * height * resolution, resolution, {}};
}

}  // namespace nadir::test
