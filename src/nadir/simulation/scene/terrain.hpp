// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "nadir/simulation/scene/ground_model.hpp"
#include "nadir/simulation/scene/height_field.hpp"
#include "nadir/simulation/scene/solid.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir::simulation {

/// A rectangle of local metres.
struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();

  bool contains(double x, double y) const {
    return x >= low.x() && y >= low.y() && x < high.x() && y < high.y();
  }
};

/// What of a place stays as it is: ground, houses, trees.
struct Terrain {
  std::uint64_t seed = 1;
  WorldOptions options;
  SiteAnchor anchor;
  Extent extent;
  Layout layout;
  std::unique_ptr<GroundModel> model;
  std::optional<Orthomosaic> draped;           ///< geo-reference in local metres
  std::optional<ElevationMap> draped_surface;  ///< the same; height 0 = the lowest, no holes
  HeightField heights;
  Raster<std::uint8_t> albedo;  ///< as Texture has it; the fourth channel is the share of plants
  std::vector<Solid> solids;

  /// Whether painted or draped.
  double height(const GroundSpot& spot) const;
  GroundSample sample(const GroundSpot& spot, const Nearby& nearby) const;
  GroundSample sample(const Eigen::Vector2d& point, float footprint, const Nearby& nearby) const;
};

/// Draws heights and colours of the whole extent.
void draw_ground(Terrain& terrain);

std::shared_ptr<const Terrain> make_terrain(std::uint64_t seed, const WorldOptions& options);
/// As SimulatedWorld::drape() has it.
std::shared_ptr<const Terrain> drape_terrain(std::uint64_t seed, const Orthomosaic& map,
                                             const std::optional<ElevationMap>& surface,
                                             std::optional<int> utm_zone);

}  // namespace nadir::simulation
