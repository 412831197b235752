// SPDX-License-Identifier: Apache-2.0
// Terrain that shows an orthomosaic.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "nadir/core/error.hpp"
#include "nadir/simulation/scene/terrain.hpp"
#include "nadir/simulation/scene/traversability.hpp"

namespace nadir::simulation {
namespace {

std::string whole(double metres) { return std::to_string(std::lround(metres)); }

void require_drapable(const Orthomosaic& map) {
  constexpr double kSmallest = 10.0;  // metres a side
  if (map.image.empty() || (map.image.channels() != 1 && map.image.channels() != 3) ||
      !map.valid.same_size(map.image)) {
    throw Error(ErrorKind::kInput, "an orthomosaic without pixels cannot be draped");
  }
  const double width = map.width() * map.geo.resolution;
  const double depth = map.height() * map.geo.resolution;
  if (std::min(width, depth) < kSmallest) {
    throw Error(ErrorKind::kInput,
                "a map of " + whole(width) + " x " + whole(depth) + " m is too small to drive on",
                {}, "give one of at least " + whole(kSmallest) + " m a side");
  }
}

/// A surface of another place would make flat ground, without a word.
void require_same_place(const Orthomosaic& map, const ElevationMap& surface) {
  constexpr double kLeastShare = 0.5;  // of the map, under known heights
  constexpr int kPerSide = 64;
  int known = 0;
  for (int i = 0; i < kPerSide * kPerSide; ++i) {
    const std::div_t place = std::div(i, kPerSide);  // quot rows down, rem across
    const double x = map.geo.x_at((place.rem + 0.5) / kPerSide * map.width());
    const double y = map.geo.y_at((place.quot + 0.5) / kPerSide * map.height());
    const PixelCoordinate at = surface.geo.pixel_at(x, y);
    const double column = std::floor(at.column);
    const double row = std::floor(at.row);
    if (column < 0.0 || row < 0.0 || column >= surface.width() || row >= surface.height()) continue;
    const float height = surface.height_m.at(static_cast<int>(column), static_cast<int>(row));
    known += std::isfinite(height) ? 1 : 0;
  }
  if (known >= kLeastShare * kPerSide * kPerSide) return;
  const auto extent = [&](const GeoReference& geo, int width, int height) {
    return whole(geo.west) + " .. " + whole(geo.x_at(width)) + " east, " + whole(geo.y_at(height)) +
           " .. " + whole(geo.north) + " north";
  };
  throw Error(ErrorKind::kInput,
              "the surface model covers " + whole(100.0 * known / (kPerSide * kPerSide)) +
                  " % of the map: its heights lie at " +
                  extent(surface.geo, surface.width(), surface.height()) + ", the map at " +
                  extent(map.geo, map.width(), map.height()),
              {}, "give a surface model of the same place in the same coordinate system");
}

/// The value of a raster at a place, or nothing beyond it.
template <class T>
std::optional<T> value_at(const Raster<T>& raster, const GeoReference& geo, double x, double y) {
  const PixelCoordinate at = geo.pixel_at(x, y);
  const auto column = static_cast<int>(std::floor(at.column));
  const auto row = static_cast<int>(std::floor(at.row));
  if (!raster.contains(column, row)) return std::nullopt;
  return raster.at(column, row);
}

/// Takes over a surface model: the lowest height under the map becomes 0, and fills its holes.
/// `corner` is the south-west one of the map.
void drape_surface(const ElevationMap& surface, const Eigen::Vector2d& corner, Terrain& terrain) {
  ElevationMap draped = surface;
  draped.geo.west -= corner.x();
  draped.geo.north -= corner.y();
  // Interpolation reads heights up to one cell away; a coarse cell may be wider than the map.
  const Eigen::Vector2d cell = Eigen::Vector2d::Constant(draped.geo.resolution);
  const Extent read{terrain.extent.low - cell, terrain.extent.high + cell};
  float lowest = std::numeric_limits<float>::infinity();
  for (int row = 0; row < draped.height(); ++row) {
    for (int column = 0; column < draped.width(); ++column) {
      const float height = draped.height_m.at(column, row);
      const bool used = read.contains(draped.geo.x_at(column + 0.5), draped.geo.y_at(row + 0.5));
      if (used && std::isfinite(height)) lowest = std::min(lowest, height);
    }
  }
  for (float& height : draped.height_m.values()) {
    height = std::isfinite(height) ? height - lowest : 0.0F;
  }
  terrain.anchor.altitude_m = lowest;
  terrain.draped_surface = std::move(draped);
}

/// Free is where nine tenths of a cell are known, in the map and the surface, and the ground rises
/// by less than 0.2 m over it.
TraversabilityGrid traversability_of(const Terrain& terrain,
                                     const std::optional<ElevationMap>& surface,
                                     const Eigen::Vector2d& corner) {
  constexpr double kSmallestCell = 0.5;
  constexpr double kMostCells = 4e6;
  constexpr int kProbes = 8;  // a side of a cell, its border included
  constexpr int kLeastKnown = 9 * kProbes * kProbes / 10;
  constexpr double kHighestRise = 0.2;
  const Orthomosaic& map = *terrain.draped;
  const Eigen::Vector2d size = terrain.extent.high - terrain.extent.low;
  const double cell =
      std::max({kSmallestCell, map.geo.resolution, std::sqrt(size.x() * size.y() / kMostCells)});
  Raster<std::uint8_t> free(static_cast<int>(size.x() / cell), static_cast<int>(size.y() / cell));
  tbb::parallel_for(0, free.height(), [&](int row) {
    for (int column = 0; column < free.width(); ++column) {
      int known = 0;
      double lowest = std::numeric_limits<double>::infinity();
      double highest = -lowest;
      for (int probe = 0; probe < kProbes * kProbes; ++probe) {
        const std::div_t at = std::div(probe, kProbes);
        const double inset = 1.0 / (kProbes - 1);
        const double x = terrain.extent.low.x() + cell * (column + at.rem * inset);
        const double y = terrain.extent.low.y() + cell * (row + at.quot * inset);
        const double height = terrain.heights.at(x, y);
        lowest = std::min(lowest, height);
        highest = std::max(highest, height);
        const bool seen = value_at(map.valid, map.geo, x, y).value_or(0) != 0;
        const bool measured =
            !surface ||
            std::isfinite(value_at(surface->height_m, surface->geo, x + corner.x(), y + corner.y())
                              .value_or(std::numeric_limits<float>::quiet_NaN()));
        if (seen && measured) ++known;
      }
      if (known >= kLeastKnown && highest - lowest < kHighestRise) free.at(column, row) = 255;
    }
  });
  return {free, terrain.extent.low, cell};
}

bool keeps_clear(const Path& path, const TraversabilityGrid& grid) {
  constexpr double kStep = 0.25;  // metres
  const auto steps = static_cast<int>(std::ceil(path.length() / kStep));
  for (int step = 0; step <= steps; ++step) {
    const Eigen::Vector2d at = path.at(path.length() * step / steps).point;
    if (grid.clearance(at) < TraversabilityGrid::kClearance) return false;
  }
  return true;
}

/// A loop around the middle of the map where that is free or nothing is, else a long path over what
/// is.
Path route_over(const Terrain& terrain, const TraversabilityGrid& grid) {
  const double width = terrain.options.width_m;
  const double depth = terrain.options.depth_m;
  const double inset = std::min(0.25 * std::min(width, depth), 30.0);
  const std::vector<Eigen::Vector2d> corners{{inset, 0.5 * depth},
                                             {inset, inset},
                                             {width - inset, inset},
                                             {width - inset, depth - inset},
                                             {inset, depth - inset}};
  Path loop(corners, std::vector<double>{0.4 * inset}, false);
  if (keeps_clear(loop, grid)) return loop;
  const std::vector<Eigen::Vector2d> path = grid.path();
  if (path.empty()) return loop;
  return {path, std::vector<double>{TraversabilityGrid::kCornerRadius}, false};
}

}  // namespace

std::shared_ptr<const Terrain> drape_terrain(std::uint64_t seed, const Orthomosaic& map,
                                             const std::optional<ElevationMap>& surface,
                                             std::optional<int> utm_zone) {
  auto terrain = std::make_shared<Terrain>();
  terrain->seed = seed;
  require_drapable(map);
  const GeoReference& geo = map.geo;
  const Eigen::Vector2d corner(geo.west, geo.y_at(map.height()));
  if (utm_zone) {
    terrain->anchor.easting_m = corner.x();
    terrain->anchor.northing_m = corner.y();
    terrain->anchor.utm_zone = *utm_zone;
    terrain->anchor.crs = geo.crs;
  }
  terrain->options.width_m = map.width() * geo.resolution;
  terrain->options.depth_m = map.height() * geo.resolution;
  terrain->options.margin_m = 0.0;
  terrain->options.relief_m = 0.0;
  terrain->options.texel_m = std::clamp(0.5 * geo.resolution, 0.02, 1.0);
  terrain->extent = {Eigen::Vector2d::Zero(), {terrain->options.width_m, terrain->options.depth_m}};
  terrain->layout.painted = false;
  terrain->draped = map;
  terrain->draped->geo = {0.0, terrain->options.depth_m, geo.resolution, {}};
  terrain->model = std::make_unique<GroundModel>(seed, terrain->layout, 0.0, terrain->extent.low,
                                                 terrain->extent.high);
  if (surface) {
    require_same_place(map, *surface);
    drape_surface(*surface, corner, *terrain);
  }
  draw_ground(*terrain);
  terrain->layout.routes.push_back(
      route_over(*terrain, traversability_of(*terrain, surface, corner)));
  return terrain;
}

}  // namespace nadir::simulation
