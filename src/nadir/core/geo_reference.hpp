// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace nadir {

/// A continuous pixel coordinate: (0, 0) is the outer corner of the first pixel, that pixel's
/// centre is (0.5, 0.5); column grows to the right (east), row downwards (south).
struct PixelCoordinate {
  double column = 0.0;
  double row = 0.0;
};

/// Where a north-up raster of square pixels lies: the outer corner of its pixel (0, 0), GDAL's
/// convention. Metres, x east, y north, in the frame of the raster's owner (the map for a global
/// orthomosaic, the robot for a local one).
struct GeoReference {
  double west = 0.0;
  double north = 0.0;
  double resolution = 0.1;  ///< metres per pixel
  std::string crs;          ///< coordinate reference system as WKT; empty = local metres

  double x_at(double column) const { return west + column * resolution; }
  double y_at(double row) const { return north - row * resolution; }
  PixelCoordinate pixel_at(double x, double y) const {
    return {(x - west) / resolution, (north - y) / resolution};
  }

  bool operator==(const GeoReference&) const = default;
};

}  // namespace nadir
