// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nadir/simulation/scene/value_noise.hpp"

namespace nadir::simulation {

enum class Material : std::uint8_t {
  kPlaster,
  kBrick,
  kFlatRoof,
  kTiles,
  kCarPaint,
  kGlass,
  kRubber,
  kBark,
  kLeaves,
  kConcrete,
  kMetal,
};

/// A face of a convex body: n . p <= offset inside.
struct Face {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  double offset = 0.0;
  Material material = Material::kConcrete;
};

struct Puff {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d radius = Eigen::Vector3d::Ones();
};

/// Where a ray meets a body.
struct BodyHit {
  double t = 0.0;
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  Material material = Material::kConcrete;
};

/// A thing that stands on the ground: a convex body of faces, or a crown of leafy puffs whose
/// outline is frayed by noise.
struct Solid {
  std::vector<Face> faces;
  std::vector<Puff> puffs;
  Eigen::AlignedBox3d box;
  Eigen::Vector3f colour{0.5F, 0.5F, 0.5F};         ///< linear reflectance
  Eigen::Vector2d axis = Eigen::Vector2d::UnitX();  ///< its long side in the plane
  double floor = 0.0;                               ///< height of its foot
  std::uint32_t number = 0;                         ///< equal for the parts of one thing

  /// First intersection of origin + t direction with t in (from, to).
  std::optional<BodyHit> meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                              double from, double to, const ValueNoise& noise) const;
};

/// An upright prism over a rectangle, as all walls and boxes are; `inset` draws its top in.
struct Block {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double yaw = 0.0;
  double half_length = 1.0;
  double half_width = 1.0;
  double bottom = 0.0;
  double top = 1.0;
  double inset_front = 0.0;  ///< metres that the top lies behind the foot
  double inset_back = 0.0;
  double inset_side = 0.0;
  Material sides = Material::kConcrete;
  Material roof = Material::kConcrete;
};

Solid make_block(const Block& block, const Eigen::Vector3f& colour, std::uint32_t number);
/// A roof of two slopes whose ridge runs along the block's length.
Solid make_gable(const Block& block, const Eigen::Vector3f& colour, std::uint32_t number);
/// An upright post of eight sides.
Solid make_post(const Eigen::Vector2d& at, double radius, double bottom, double top,
                Material material, const Eigen::Vector3f& colour, std::uint32_t number);
Solid make_puffs(std::vector<Puff> puffs, const Eigen::Vector3f& colour, std::uint32_t number);

}  // namespace nadir::simulation
