// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/terrain.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "nadir/simulation/scene/ground_spot.hpp"
#include "nadir/simulation/scene/texture.hpp"
#include "nadir/simulation/scene/things.hpp"

namespace nadir::simulation {
namespace {

constexpr int kBlockTexels = 32;  ///< texels a side that share one list of what is near

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

}  // namespace

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

}  // namespace nadir::simulation
