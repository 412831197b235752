// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "nadir/simulation/scene/caster.hpp"
#include "nadir/simulation/scene/terrain.hpp"
#include "nadir/simulation/scene/texture.hpp"

namespace nadir::simulation {

/// Light of an hour; radiances are such that a white, level surface in the sun has 1.
struct Light {
  Eigen::Vector3d to_sun = Eigen::Vector3d::UnitZ();
  Eigen::Vector3f sun = Eigen::Vector3f::Ones();  ///< on a surface that faces it
  Eigen::Vector3f sky = Eigen::Vector3f::Zero();  ///< on a level surface
};

/// A terrain in the light and the traffic of an hour.
class Scene {
 public:
  Scene(std::shared_ptr<const Terrain> terrain, const Appearance& appearance);

  const Terrain& terrain() const { return *terrain_; }
  const Caster& caster() const { return *caster_; }
  const Light& light() const { return light_; }

  /// Linear radiance of what a ray met. `width` is that of the pixel there, across the ray, metres.
  Eigen::Vector3f colour(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         const RayHit& hit, double width, const Movers* movers = nullptr) const;
  /// The cars that are under way, so many seconds after the beginning of the hour.
  Movers traffic(double seconds) const;
  /// Of the ground: lit texture, finest where refine() was asked.
  Eigen::Vector3f ground_colour(double x, double y, float footprint) const;
  void refine(std::span<const Pose2> places, double radius_m);

 private:
  void park_cars(std::vector<Solid>& solids) const;
  /// How fast the ground rises under a ray that moves on, metres a unit of its parameter.
  double rise_along(const Eigen::Vector3d& point, const Eigen::Vector3d& direction) const;
  /// What of the light is left on the ground beside the movers, 0 .. 1 of each colour.
  Eigen::Vector3f shadow_of(const Movers& movers, const Eigen::Vector3d& point) const;
  void cast_shadows();
  void light_ground();
  /// Reflectance -> radiance of the ground at a point.
  Eigen::Vector3f lit(const Eigen::Vector4f& albedo, double x, double y) const;
  Eigen::Vector3f sky(const Eigen::Vector3d& direction) const;
  Eigen::Vector3f solid_colour(const Eigen::Vector3d& point, const RayHit& hit,
                               float footprint) const;
  Eigen::Vector3f material(const Solid& solid, const Eigen::Vector3d& point, const RayHit& hit,
                           float footprint) const;
  Eigen::Vector3f tinted(const Eigen::Vector3f& colour, float plants) const;

  std::shared_ptr<const Terrain> terrain_;
  Appearance appearance_;
  float dryness_;
  Light light_;
  ValueNoise noise_;
  std::unique_ptr<Caster> caster_;
  Raster<std::uint8_t> sunlit_;  ///< 255 = in the sun; row 0 is south
  double sunlit_texel_m_ = 0.1;
  Texture ground_;
  std::vector<std::unique_ptr<Texture>> tiles_;  ///< finest detail, where it was asked
  int tile_columns_ = 0;
  int tile_rows_ = 0;
};

}  // namespace nadir::simulation
