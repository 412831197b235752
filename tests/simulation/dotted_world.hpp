// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <vector>

#include "nadir/simulation/simulated_world.hpp"

namespace nadir::test {

/// A level square of grey with soft white dots at known places, every 2 m: what a camera shows of
/// it can be said exactly. Its surface lies at `height` over a corner that is lower.
struct DottedWorld {
  static constexpr double kSide = 40.0;
  static constexpr double kPeriod = 2.0;

  SimulatedWorld world;
  std::vector<Eigen::Vector3d> dots;
};

inline DottedWorld dotted_world(double height, double dot_sigma_m, double resolution) {
  const int side = static_cast<int>(std::lround(DottedWorld::kSide / resolution));
  Orthomosaic map{Raster<std::uint8_t>(side, side, 60),
                  Raster<std::uint8_t>(side, side, 255),
                  {0.0, DottedWorld::kSide, resolution, {}}};
  std::vector<Eigen::Vector3d> dots;
  for (double x = 1.013; x < DottedWorld::kSide; x += DottedWorld::kPeriod) {
    for (double y = 1.027; y < DottedWorld::kSide; y += DottedWorld::kPeriod) {
      dots.emplace_back(x, y, height);
      const PixelCoordinate middle = map.geo.pixel_at(x, y);
      const int reach = static_cast<int>(4.0 * dot_sigma_m / resolution) + 1;
      for (int row = static_cast<int>(middle.row) - reach; row <= middle.row + reach; ++row) {
        for (int column = static_cast<int>(middle.column) - reach; column <= middle.column + reach;
             ++column) {
          if (!map.image.contains(column, row)) continue;
          const double u = (column + 0.5 - middle.column) * resolution / dot_sigma_m;
          const double v = (row + 0.5 - middle.row) * resolution / dot_sigma_m;
          map.image.at(column, row) =
              static_cast<std::uint8_t>(60.5 + 150.0 * std::exp(-0.5 * (u * u + v * v)));
        }
      }
    }
  }
  ElevationMap surface{Raster<float>(40, 40, 100.0F + static_cast<float>(height)),
                       {0.0, DottedWorld::kSide, 1.0, {}}};
  surface.height_m.at(0, 0) = 100.0F;
  return {SimulatedWorld::drape(map, surface), dots};
}

/// Centre of brightness within `radius` pixels of a place, above the grey around it.
inline Eigen::Vector2d centre_of_light(const Raster<std::uint8_t>& image,
                                       const Eigen::Vector2d& near, double radius) {
  Eigen::Vector2d at = near;
  for (int i = 0; i < 4; ++i) {  // the window follows what it finds
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double total = 0.0;
    double ground = 255.0;
    for (const bool measure : {false, true}) {
      for (int row = 0; row < image.height(); ++row) {
        for (int column = 0; column < image.width(); ++column) {
          if ((Eigen::Vector2d(column, row) - at).norm() > radius) continue;
          const double value = image.at(column, row, image.channels() == 3 ? 1 : 0);
          if (!measure) ground = std::min(ground, value);
          if (!measure) continue;
          sum += (value - ground) * Eigen::Vector2d(column, row);
          total += value - ground;
        }
      }
    }
    at = sum / total;
  }
  return at;
}

}  // namespace nadir::test
