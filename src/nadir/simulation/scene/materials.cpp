// SPDX-License-Identifier: Apache-2.0
// How the things of a scene look: their material, in its light.
#include <algorithm>
#include <cmath>

#include "nadir/simulation/scene/scene.hpp"

namespace nadir::simulation {
namespace {

using Rgb = Eigen::Vector3f;

enum MaterialLayer : std::uint32_t {
  kDirt = 800,
  kBricks,
  kPanes,
  kShingle,
  kMoss,
  kFoliage,
  kFoliageFine,
  kBarkGrain,
  kRoofStain,
  kLeafTilt,
};

/// Coordinates on a wall: metres along it and above its foot.
struct WallPoint {
  float u = 0.0F;
  float v = 0.0F;
};

WallPoint on_wall(const Solid& solid, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
  Eigen::Vector2d along(-normal.y(), normal.x());
  const double length = along.norm();
  along = length > 1e-6 ? Eigen::Vector2d(along / length) : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d middle = solid.box.center().head<2>();
  return {static_cast<float>(along.dot(point.head<2>() - middle)),
          static_cast<float>(point.z() - solid.floor)};
}

float fraction(float value) { return value - std::floor(value); }

Rgb wall(const Solid& solid, const WallPoint& at, bool brick, float footprint,
         const ValueNoise& noise) {
  const float soft = std::max(0.5F * footprint, 0.004F);
  const float stain = noise.fractal(at.u, 0.5F * at.v, 2.4F, 6, kDirt + solid.number, footprint);
  Rgb colour = solid.colour * (1.0F + 0.12F * stain);
  if (brick) {
    const float row = std::floor(at.v / 0.085F);
    const float u = at.u / 0.25F + 0.5F * fraction(0.5F * row) * 2.0F;
    const float joint =
        std::min(std::min(fraction(u), 1.0F - fraction(u)) * 0.25F,
                 std::min(fraction(at.v / 0.085F), 1.0F - fraction(at.v / 0.085F)) * 0.085F);
    const float mortar =
        (1.0F - ease_between(0.006F - soft, 0.006F + soft, joint)) * std::min(1.0F, 0.03F / soft);
    const float tone = noise.cell_value(static_cast<std::int32_t>(std::floor(u)),
                                        static_cast<std::int32_t>(row), kBricks) -
                       0.5F;
    colour *= 1.0F + 0.5F * tone * std::min(1.0F, 0.06F / footprint);
    colour += 0.7F * mortar * (Rgb(0.36F, 0.33F, 0.29F) - colour);
  }
  colour *= 1.0F - 0.35F * (1.0F - ease_between(0.0F, 0.5F, at.v));  // splashes at the foot
  // Windows of every storey.
  const auto height = static_cast<float>(solid.box.max().z() - solid.floor);
  const float storey = at.v / 2.9F;
  if (height > 2.6F && at.v > 0.0F && 2.9F * std::floor(storey) + 2.3F < height) {
    const float bay = at.u / 2.3F;
    const float x = std::abs(fraction(bay) - 0.5F) * 2.3F;
    const float y = fraction(storey) * 2.9F;
    const float frame = strip_share(x, -1.0F, 0.62F, soft) * strip_share(y, 0.85F, 2.25F, soft);
    const float glass = strip_share(x, 0.03F, 0.56F, soft) * strip_share(y, 0.91F, 2.19F, soft);
    const float tone =
        noise.cell_value(static_cast<std::int32_t>(std::floor(bay)),
                         static_cast<std::int32_t>(std::floor(storey)), kPanes + solid.number);
    colour += frame * (Rgb(0.55F, 0.55F, 0.53F) - colour);
    colour += glass * (Rgb(0.045F, 0.06F, 0.075F) * (0.5F + 1.6F * tone) - colour);
  }
  return colour;
}

Rgb flat_roof(const Solid& solid, const Eigen::Vector3d& point, float footprint,
              const ValueNoise& noise) {
  const auto x = static_cast<float>(point.head<2>().dot(solid.axis));
  const auto y = static_cast<float>(point.x() * -solid.axis.y() + point.y() * solid.axis.x());
  const float stain = noise.fractal(x, y, 4.0F, 7, kRoofStain + solid.number, footprint, 0.6F);
  const float grit = noise.fractal(x, y, 0.06F, 3, kShingle, footprint, 0.8F);
  const float seam = fraction(y / 1.05F) * 1.05F;
  const float soft = std::max(0.5F * footprint, 0.01F);
  const float joint = strip_share(seam, 0.02F, 0.08F, soft);
  const bool light = (solid.number % 3U) == 0;
  const Rgb base = light ? Rgb(0.33F, 0.315F, 0.29F) : Rgb(0.155F, 0.155F, 0.155F);
  return base * (1.0F + 0.26F * stain + 0.2F * grit - (light ? 0.05F : 0.25F) * joint);
}

Rgb tiled_roof(const Solid& solid, const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
               float footprint, const ValueNoise& noise) {
  const Eigen::Vector3d down = Eigen::Vector3d(normal.x(), normal.y(), 0.0).normalized();
  const auto slope = static_cast<float>(point.dot(down) / std::max(normal.z(), 0.1));
  const auto along = static_cast<float>(point.x() * -down.y() + point.y() * down.x());
  const float row = slope / 0.33F;
  const float column =
      along / 0.28F + 0.5F * static_cast<float>(static_cast<std::int32_t>(std::floor(row)) & 1);
  const float seen = std::clamp(0.3F / footprint - 1.0F, 0.0F, 1.0F);
  const float tone = noise.cell_value(static_cast<std::int32_t>(std::floor(column)),
                                      static_cast<std::int32_t>(std::floor(row)), kShingle) -
                     0.5F;
  const float round = std::sin(3.1416F * fraction(column)) - 0.64F;
  const float edge = 1.0F - ease_between(0.0F, 0.2F, fraction(row));
  const float moss = ease_between(
      0.25F, 0.7F, noise.fractal(along, slope, 2.6F, 6, kMoss + solid.number, footprint, 0.6F));
  Rgb colour = solid.colour * (1.0F + seen * (0.34F * tone + 0.22F * round - 0.3F * edge));
  colour += 0.6F * moss * (Rgb(0.085F, 0.095F, 0.055F) - colour);
  return colour;
}

Rgb leaves(const Solid& solid, const Eigen::Vector3d& point, float footprint,
           const ValueNoise& noise) {
  const auto x = static_cast<float>(point.x());
  const auto y = static_cast<float>(point.y());
  const auto z = static_cast<float>(point.z());
  const float clump = noise.at(x, y, z, 0.55F, kFoliage);
  const float leaf =
      noise.at(x, y, z, 0.13F, kFoliageFine) * std::clamp(0.13F / footprint - 0.2F, 0.0F, 1.0F);
  const float tiny = noise.at(x, y, z, 0.045F, kFoliageFine + 1U) *
                     std::clamp(0.045F / footprint - 0.3F, 0.0F, 1.0F);
  return solid.colour * std::max(0.15F, 1.0F + 0.3F * clump + 0.45F * leaf + 0.4F * tiny);
}

}  // namespace

Eigen::Vector3f Scene::material(const Solid& solid, const Eigen::Vector3d& point, const RayHit& hit,
                                float footprint) const {
  switch (hit.material) {
    case Material::kPlaster:
    case Material::kBrick:
      return wall(solid, on_wall(solid, point, hit.normal), hit.material == Material::kBrick,
                  footprint, noise_);
    case Material::kFlatRoof:
      return flat_roof(solid, point, footprint, noise_);
    case Material::kTiles:
      return tiled_roof(solid, point, hit.normal, footprint, noise_);
    case Material::kLeaves:
      return tinted(leaves(solid, point, footprint, noise_), 0.8F);
    case Material::kGlass:
      return {0.035F, 0.045F, 0.055F};
    case Material::kRubber:
      return {0.02F, 0.02F, 0.021F};
    case Material::kBark: {
      const auto x = static_cast<float>(point.x() + point.y());
      const auto z = static_cast<float>(point.z());
      return solid.colour *
             (1.0F + 0.5F * noise_.fractal(6.0F * x, z, 0.4F, 4, kBarkGrain, footprint));
    }
    case Material::kCarPaint:
    case Material::kConcrete:
    case Material::kMetal:
      break;
  }
  return solid.colour;
}

Eigen::Vector3f Scene::solid_colour(const Eigen::Vector3d& point, const RayHit& hit,
                                    float footprint) const {
  const Solid& solid = *hit.body;
  const Eigen::Vector3f albedo = material(solid, point, hit, footprint);
  const bool leafy = hit.material == Material::kLeaves;
  double facing = hit.normal.dot(light_.to_sun);
  // Light passes through leaves, and they lie at all angles.
  if (leafy) {
    const auto x = static_cast<float>(point.x());
    const auto y = static_cast<float>(point.y());
    const auto z = static_cast<float>(point.z());
    const float seen = std::clamp(0.2F / footprint - 0.3F, 0.0F, 1.0F);
    facing += 0.45 * static_cast<double>(seen * noise_.at(x, y, z, 0.2F, kLeafTilt));
    facing = 0.22 + 0.78 * std::max(facing, -0.15);
  }
  bool sunlit = facing > 0.0;
  if (sunlit) {
    const Eigen::Vector3d off = point + (leafy ? 0.12 : 0.02) * hit.normal;
    sunlit = caster_->is_free(off, light_.to_sun, leafy ? 0.15 : 1e-3, 60.0);
  }
  const auto sun = sunlit ? static_cast<float>(facing) : 0.0F;
  const auto open = static_cast<float>(0.5 + 0.5 * hit.normal.z());
  Eigen::Vector3f light =
      sun * light_.sun + (leafy ? 0.35F + 0.55F * open : 0.25F + 0.75F * open) * light_.sky;
  Eigen::Vector3f colour = albedo.cwiseProduct(light);
  if (hit.material == Material::kGlass || hit.material == Material::kCarPaint) {
    // The sky shines in what is glossy.
    const float gloss = hit.material == Material::kGlass ? 0.10F : 0.05F;
    colour += gloss * open * light_.sky * 2.0F;
  }
  return colour.cwiseMin(1.5F);
}

}  // namespace nadir::simulation
