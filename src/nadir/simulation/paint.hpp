// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "nadir/core/geo_reference.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/simulation/noise.hpp"
#include "nadir/simulation/road.hpp"

namespace nadir::simulation {

/// RGB, 0 .. 255.
struct Colour {
  double red = 0.0;
  double green = 0.0;
  double blue = 0.0;
};

inline Colour operator*(Colour colour, double factor) {
  return {colour.red * factor, colour.green * factor, colour.blue * factor};
}

inline Colour mix(Colour from, Colour to, double share) {
  return {from.red + share * (to.red - from.red), from.green + share * (to.green - from.green),
          from.blue + share * (to.blue - from.blue)};
}

/// How much of a strip edge at `low` and `high` covers `value`, with a soft edge of half width
/// `soft`: 1 inside, 0 outside.
inline double strip(double value, double low, double high, double soft = 0.03) {
  return smooth_step(low - soft, low + soft, value) *
         (1.0 - smooth_step(high - soft, high + soft, value));
}

/// The canvas that a site is painted on: linear colour, finer than the finished orthomosaic.
struct Painting {
  Raster<float> image;  ///< 3 channels
  GeoReference geo;     ///< map frame

  Colour colour(int column, int row) const {
    return {image.at(column, row, 0), image.at(column, row, 1), image.at(column, row, 2)};
  }
  void set(int column, int row, Colour colour) {
    image.at(column, row, 0) = static_cast<float>(colour.red);
    image.at(column, row, 1) = static_cast<float>(colour.green);
    image.at(column, row, 2) = static_cast<float>(colour.blue);
  }
  Point2<frames::Map> centre(int column, int row) const {
    return {geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
  }
};

/// What all painters of a site share.
struct Place {
  std::uint64_t seed = 0;
  double length_m = 0.0;
  double width_m = 0.0;
  Road road;
  SmoothNoise noise;
  double sun_azimuth = 0.0;  ///< direction towards the sun, radians counter-clockwise from east
};

// Metres from the centre line, both sides.
inline constexpr double kLaneMiddle = 1.75;
inline constexpr double kEdgeLine = 3.25;
inline constexpr double kKerbInner = 3.6;
inline constexpr double kKerbOuter = 3.8;
inline constexpr double kPavementOuter = 6.2;
inline constexpr double kEdgingOuter = 6.32;

}  // namespace nadir::simulation
