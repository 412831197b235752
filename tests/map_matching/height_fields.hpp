// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/frames.hpp"
#include "nadir/core/random.hpp"

namespace nadir::test {

/// A street known exactly at every point: a road from west to east between kerbs, pavements,
/// hedges, parked cars and houses, on sloping ground. Metres; `datum_m` is the height of its zero.
class Street {
 public:
  explicit Street(std::uint64_t seed, double slope_east = 0.02, double datum_m = 0.0)
      : random_(seed, 41), slope_(slope_east), datum_(datum_m) {}

  double operator()(double x, double y) const {
    const double across = y - 10.0 - 0.8 * std::sin(x / 7.0);  // from the middle of the road
    double height = datum_ + slope_ * x;
    if (std::abs(across) > 3.5) height += 0.12;
    const auto plot = static_cast<std::uint64_t>(std::floor(x / 5.0) + 100.0);
    const double along = x - 5.0 * std::floor(x / 5.0);
    const double width = random_.uniform(4 * plot, 1.0, 4.0);
    const bool left = random_.uniform(4 * plot + 1) < 0.5;
    const double side = left ? across : -across;
    if (along > width) return height;
    if (side > 5.5 && side < 6.2) return height + 0.9;  // hedge
    if (side > 7.5) return height + 6.0;                // house
    if (random_.uniform(4 * plot + 2) < 0.3 && side > 1.8 && side < 3.4)
      return height + 1.4;  // car
    return height;
  }

 private:
  RandomStream random_;
  double slope_;
  double datum_;
};

/// Heights of the street on the pixels of `geo`, through the pose of `geo`'s frame in the map.
inline ElevationMap heights_of(const Street& street, int width, int height, const GeoReference& geo,
                               const Pose2& map_from_frame) {
  ElevationMap heights{Raster<float>(width, height), geo};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const auto point =
          map_from_frame * Point2<frames::Robot>{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      heights.height_m.at(column, row) = static_cast<float>(street(point.x, point.y));
    }
  }
  return heights;
}

/// What a sensor makes of it: noise, and holes.
inline void degrade(ElevationMap& heights, std::uint64_t seed, double noise_m, double hole_share) {
  const RandomStream random(seed, 43);
  for (std::size_t i = 0; i < heights.height_m.values().size(); ++i) {
    float& height = heights.height_m.values()[i];
    height += static_cast<float>(noise_m * random.normal(2 * i));
    if (random.uniform(2 * i + 1) < hole_share) height = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace nadir::test
