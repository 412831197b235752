// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nadir/simulation/scene/layout.hpp"
#include "nadir/simulation/scene/value_noise.hpp"

namespace nadir::simulation {

/// What the ground looks like at a point.
struct GroundSample {
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();  ///< linear reflectance, RGB
  float plants = 0.0F;                               ///< share that the season tints, 0 .. 1
};

/// The parts of a layout that can show in a small region.
struct Nearby {
  std::vector<const Road*> roads;
  std::vector<const Area*> areas;
  std::vector<const Decal*> decals;
  std::vector<const Tree*> trees;
};

struct GroundSpot;  // where a point lies against everything near it

/// The bare ground as a function of the plane: its height and, down to a centimetre, its colour.
class GroundModel {
 public:
  GroundModel(std::uint64_t seed, const Layout& layout, double relief_m, Eigen::Vector2d low,
              Eigen::Vector2d high);

  /// What shows within `reach` metres of a point.
  Nearby near(const Eigen::Vector2d& point, double reach) const;
  /// How a point, seen by a pixel of width `footprint` metres, lies against all that is near it.
  static GroundSpot locate(const Eigen::Vector2d& point, float footprint, const Nearby& nearby);
  /// Height above the datum of the world; kerbs, cambers and gutters included.
  double height(const GroundSpot& spot) const;
  /// Colour as that pixel sees it.
  GroundSample sample(const GroundSpot& spot, const Nearby& nearby) const;

 private:
  double relief(const Eigen::Vector2d& point) const;

  GroundSample grass(const GroundSpot& spot, const Nearby& nearby) const;
  GroundSample asphalt(const GroundSpot& spot, const Nearby& nearby) const;
  GroundSample paving(const GroundSpot& spot, float slab_length, float slab_width) const;
  GroundSample gravel(const GroundSpot& spot) const;
  GroundSample crop(const GroundSpot& spot, const Area& area) const;
  GroundSample bed(const GroundSpot& spot) const;
  GroundSample area_surface(const GroundSpot& spot, const Area& area, const Nearby& nearby) const;
  float cracks(const GroundSpot& spot) const;
  float paint(const GroundSpot& spot, const Nearby& nearby) const;
  void add_decals(const GroundSpot& spot, const Nearby& nearby, GroundSample& sample) const;

  ValueNoise noise_;
  const Layout& layout_;
  double relief_m_;
  Eigen::Vector2d low_;
  Eigen::Vector2d high_;
};

}  // namespace nadir::simulation
