// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "nadir/simulation/scene/height_field.hpp"
#include "nadir/simulation/scene/solid.hpp"

namespace nadir::simulation {

/// What a ray met first.
struct RayHit {
  static constexpr int kSky = -2;
  static constexpr int kGround = -1;

  double t = 0.0;
  int solid = kSky;  ///< index of the solid, or one of the above; movers follow the solids
  const Solid* body = nullptr;  ///< where a solid was met
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Material material = Material::kConcrete;
};

/// Things that are elsewhere at every instant; a ray asks them one after the other.
struct Movers {
  struct Thing {
    Eigen::AlignedBox3d box;
    std::vector<Solid> solids;
  };
  std::vector<Thing> things;

  void add(std::vector<Solid> solids);
};

/// Finds what rays meet, over the ground and the solids on it. Cells of the plane hold what can
/// lie in them, so that a ray looks only at what it passes.
class Caster {
 public:
  Caster(const HeightField& ground, std::vector<Solid> solids, std::uint64_t seed);

  /// The first thing at origin + t direction with t in (from, to). Beyond the height field the
  /// ground goes on as a plane at height 0.
  RayHit cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from = 0.0,
              double to = 1e9, const Movers* movers = nullptr) const;
  /// Nothing between the two parameters of the ray but the bare ground, which is not asked.
  bool is_free(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from,
               double to) const;
  /// Within the convex body of a solid.
  bool is_inside(const Eigen::Vector3d& point) const;
  const std::vector<Solid>& solids() const { return solids_; }
  /// Whether any solid reaches into the cell that holds this place.
  bool is_bare(double x, double y) const;

 private:
  struct Cell {
    double ground_top = 0.0;
    double top = 0.0;
    std::vector<std::uint32_t> solids;
  };
  template <class Visit>
  void walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from, double to,
            const Visit& visit) const;
  const Cell* cell_at(double x, double y) const;
  void meet_movers(const Movers& movers, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction, double from, RayHit& best) const;
  void meet_solids(const Cell& cell, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction, double from, RayHit& best) const;

  const HeightField& ground_;
  std::vector<Solid> solids_;
  ValueNoise noise_;
  Raster<Cell> cells_;
  double top_ = 0.0;
};

}  // namespace nadir::simulation
