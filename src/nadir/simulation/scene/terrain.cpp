// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/terrain.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "nadir/core/error.hpp"
#include "nadir/simulation/scene/free_way.hpp"
#include "nadir/simulation/scene/ground_spot.hpp"
#include "nadir/simulation/scene/texture.hpp"
#include "nadir/simulation/scene/things.hpp"

namespace nadir::simulation {
namespace {

constexpr int kBlockTexels = 32;  ///< texels a side that share one list of what is near

/// Draws heights and colours of the whole extent, block by block.
void draw_ground(Terrain& terrain) {
  const double texel = terrain.options.texel_m;
  const Eigen::Vector2d size = terrain.extent.high - terrain.extent.low;
  const int width = static_cast<int>(std::ceil(size.x() / texel));
  const int height = static_cast<int>(std::ceil(size.y() / texel));
  Raster<float> nodes(width, height);
  terrain.albedo = Raster<std::uint8_t>(width, height, 0, 4);
  const int block_rows = (height + kBlockTexels - 1) / kBlockTexels;
  tbb::parallel_for(0, block_rows, [&](int block_row) {
    for (int left = 0; left < width; left += kBlockTexels) {
      const int top = block_row * kBlockTexels;
      const Eigen::Vector2d middle =
          terrain.extent.low +
          texel * Eigen::Vector2d(left + 0.5 * kBlockTexels, top + 0.5 * kBlockTexels);
      const Nearby nearby = terrain.model->near(middle, 0.75 * kBlockTexels * texel);
      for (int row = top; row < std::min(top + kBlockTexels, height); ++row) {
        for (int column = left; column < std::min(left + kBlockTexels, width); ++column) {
          const Eigen::Vector2d point =
              terrain.extent.low + texel * Eigen::Vector2d(column + 0.5, row + 0.5);
          const GroundSpot spot = GroundModel::locate(point, static_cast<float>(texel), nearby);
          nodes.at(column, row) = static_cast<float>(terrain.height(spot));
          const GroundSample sample = terrain.sample(spot, nearby);
          for (int channel = 0; channel < 3; ++channel) {
            terrain.albedo.at(column, row, channel) = encoded(sample.albedo[channel]);
          }
          terrain.albedo.at(column, row, 3) = encoded(sample.plants);
        }
      }
    }
  });
  terrain.heights = HeightField(std::move(nodes), terrain.extent.low, texel);
}

void build_things(Terrain& terrain) {
  const Layout& layout = terrain.layout;
  const auto ground = [&](const Eigen::Vector2d& p) { return terrain.heights.at(p.x(), p.y()); };
  for (const Building& building : layout.buildings) {
    add_building(building, ground(building.plan.centre), terrain.seed, terrain.solids);
  }
  for (const Barrier& barrier : layout.barriers) {
    add_barrier(barrier, ground(barrier.plan.centre), terrain.seed, terrain.solids);
  }
  for (const Post& post : layout.posts) add_post(post, ground(post.at), terrain.solids);
  for (const Tree& tree : layout.trees) {
    add_tree(tree, ground(tree.at), terrain.seed, terrain.solids);
  }
}

Layout lay_out(WorldPreset preset, std::uint64_t seed, double width_m, double depth_m) {
  switch (preset) {
    case WorldPreset::kCampus:
      return lay_out_campus(seed, width_m, depth_m);
    case WorldPreset::kParking:
      return lay_out_parking(seed, width_m, depth_m);
    case WorldPreset::kFarm:
      return lay_out_farm(seed, width_m, depth_m);
  }
  return {};
}

/// Bilinear colour of a mosaic, as linear reflectance; holes are plain grey.
Eigen::Vector3f mosaic_colour(const Orthomosaic& map, const Eigen::Vector2d& point) {
  const PixelCoordinate pixel = map.geo.pixel_at(point.x(), point.y());
  const double u = std::clamp(pixel.column - 0.5, 0.0, std::max(map.width() - 1.001, 0.0));
  const double v = std::clamp(pixel.row - 0.5, 0.0, std::max(map.height() - 1.001, 0.0));
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < 4; ++i) {
    const int c = std::min(column + (i & 1), map.width() - 1);
    const int r = std::min(row + (i >> 1), map.height() - 1);
    const auto share = static_cast<float>(((i & 1) != 0 ? u - column : 1.0 - u + column) *
                                          ((i >> 1) != 0 ? v - row : 1.0 - v + row));
    for (int channel = 0; channel < 3; ++channel) {
      const int from = map.image.channels() == 3 ? channel : 0;
      const float value = map.valid.at(c, r) == 0 ? 90.0F : map.image.at(c, r, from);
      sum[channel] += share * 0.62F * std::pow(value / 255.0F, 2.2F);
    }
  }
  return sum;
}

double surface_height(const ElevationMap& surface, const Eigen::Vector2d& point) {
  const PixelCoordinate pixel = surface.geo.pixel_at(point.x(), point.y());
  const double u = std::clamp(pixel.column - 0.5, 0.0, std::max(surface.width() - 1.001, 0.0));
  const double v = std::clamp(pixel.row - 0.5, 0.0, std::max(surface.height() - 1.001, 0.0));
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const int right = std::min(column + 1, surface.width() - 1);
  const int below = std::min(row + 1, surface.height() - 1);
  const double a = u - column;
  const double b = v - row;
  const Raster<float>& height = surface.height_m;
  return (1.0 - b) * ((1.0 - a) * height.at(column, row) + a * height.at(right, row)) +
         b * ((1.0 - a) * height.at(column, below) + a * height.at(right, below));
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
  const auto whole = [](double metres) { return std::to_string(std::lround(metres)); };
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

/// Takes over a surface model: its lowest height becomes 0, and fills its holes. `corner` is the
/// south-west one of the map.
void drape_surface(const ElevationMap& surface, const Eigen::Vector2d& corner, Terrain& terrain) {
  float lowest = std::numeric_limits<float>::infinity();
  for (const float height : surface.height_m.values()) {
    if (std::isfinite(height)) lowest = std::min(lowest, height);
  }
  if (!std::isfinite(lowest)) {
    throw Error(ErrorKind::kInput, "a surface model without any height cannot be draped");
  }
  ElevationMap draped = surface;
  for (float& height : draped.height_m.values()) {
    height = std::isfinite(height) ? height - lowest : 0.0F;
  }
  draped.geo.west -= corner.x();
  draped.geo.north -= corner.y();
  terrain.anchor.altitude_m = lowest;
  terrain.draped_surface = std::move(draped);
}

/// Where the map and the surface are known and a robot does not climb.
FreeGround free_ground(const Terrain& terrain, const std::optional<ElevationMap>& surface,
                       const Eigen::Vector2d& corner) {
  constexpr double kCell = 0.5;
  constexpr double kSteepest = 0.25;  // metres of height a metre, 14 degrees
  const Orthomosaic& map = *terrain.draped;
  const Eigen::Vector2d size = terrain.extent.high - terrain.extent.low;
  FreeGround ground{
      Raster<std::uint8_t>(static_cast<int>(size.x() / kCell), static_cast<int>(size.y() / kCell)),
      terrain.extent.low, kCell};
  const auto is_known = [](const auto& raster, const PixelCoordinate& at, const auto& known) {
    const int column = static_cast<int>(std::floor(at.column));
    const int row = static_cast<int>(std::floor(at.row));
    return raster.contains(column, row) && known(raster.at(column, row));
  };
  const auto rise = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& half) {
    const Eigen::Vector2d from = p - half;
    const Eigen::Vector2d to = p + half;
    return std::abs(terrain.heights.at(to.x(), to.y()) - terrain.heights.at(from.x(), from.y()));
  };
  for (int row = 0; row < ground.free.height(); ++row) {
    for (int column = 0; column < ground.free.width(); ++column) {
      const Eigen::Vector2d p = ground.middle(column, row);
      const bool seen = is_known(map.valid, map.geo.pixel_at(p.x(), p.y()),
                                 [](std::uint8_t valid) { return valid != 0; });
      const bool measured =
          !surface ||
          is_known(surface->height_m, surface->geo.pixel_at(p.x() + corner.x(), p.y() + corner.y()),
                   [](float height) { return std::isfinite(height); });
      const bool level = rise(p, {kCell, 0.0}) < 2.0 * kCell * kSteepest &&
                         rise(p, {0.0, kCell}) < 2.0 * kCell * kSteepest;
      if (seen && measured && level) ground.free.at(column, row) = 255;
    }
  }
  return ground;
}

/// A route of its own: a round through the middle of the map where that is free, else a long way
/// over what is.
void add_route(Terrain& terrain, const std::optional<ElevationMap>& surface,
               const Eigen::Vector2d& corner) {
  const double width = terrain.options.width_m;
  const double depth = terrain.options.depth_m;
  const double inset = std::min(0.25 * std::min(width, depth), 30.0);
  const std::vector<Eigen::Vector2d> corners{{inset, 0.5 * depth},
                                             {inset, inset},
                                             {width - inset, inset},
                                             {width - inset, depth - inset},
                                             {inset, depth - inset}};
  const Path round(corners, std::vector<double>{0.4 * inset}, false);
  const FreeGround ground = free_ground(terrain, surface, corner);
  bool free = true;
  for (double along = 0.0; along < round.length() && free; along += ground.cell_m) {
    free = ground.at(round.at(along).point);
  }
  const std::vector<Eigen::Vector2d> way = free ? std::vector<Eigen::Vector2d>{} : free_way(ground);
  terrain.layout.routes.push_back(
      way.empty() ? round : Path(way, std::vector<double>{kFreeWayRadius}, false));
}

}  // namespace

double Terrain::height(const GroundSpot& spot) const {
  return draped_surface ? surface_height(*draped_surface, spot.point) : model->height(spot);
}

GroundSample Terrain::sample(const GroundSpot& spot, const Nearby& nearby) const {
  if (!draped) return model->sample(spot, nearby);
  return {mosaic_colour(*draped, spot.point), 0.0F};
}

GroundSample Terrain::sample(const Eigen::Vector2d& point, float footprint,
                             const Nearby& nearby) const {
  return sample(GroundModel::locate(point, footprint, nearby), nearby);
}

std::shared_ptr<const Terrain> make_terrain(std::uint64_t seed, const WorldOptions& options) {
  auto terrain = std::make_shared<Terrain>();
  terrain->seed = seed;
  terrain->options = options;
  const Eigen::Vector2d margin(options.margin_m, options.margin_m);
  terrain->extent = {-margin, Eigen::Vector2d(options.width_m, options.depth_m) + margin};
  terrain->layout = lay_out(options.preset, seed, options.width_m, options.depth_m);
  terrain->model = std::make_unique<GroundModel>(seed, terrain->layout, options.relief_m,
                                                 terrain->extent.low, terrain->extent.high);
  draw_ground(*terrain);
  build_things(*terrain);
  return terrain;
}

std::shared_ptr<const Terrain> drape_terrain(std::uint64_t seed, const Orthomosaic& map,
                                             const std::optional<ElevationMap>& surface,
                                             std::optional<int> utm_zone) {
  auto terrain = std::make_shared<Terrain>();
  terrain->seed = seed;
  if (map.image.empty() || (map.image.channels() != 1 && map.image.channels() != 3)) {
    throw Error(ErrorKind::kInput, "an orthomosaic without pixels cannot be draped");
  }
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
  add_route(*terrain, surface, corner);
  return terrain;
}

}  // namespace nadir::simulation
