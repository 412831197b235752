// SPDX-License-Identifier: Apache-2.0
// The surfaces of the ground, as linear reflectances of red, green and blue.
#include <algorithm>
#include <cmath>

#include "nadir/simulation/scene/ground_spot.hpp"

namespace nadir::simulation {
namespace {

using Rgb = Eigen::Vector3f;

Rgb blend(const Rgb& from, const Rgb& to, float share) { return from + share * (to - from); }

/// A pattern of leaves or pebbles: the share of a pixel that is covered where each cell of the
/// lattice holds one with probability `density`.
float scattered(const ValueNoise& noise, float x, float y, float cell, float density,
                std::uint32_t layer, float footprint) {
  const float u = x / cell;
  const float v = y / cell;
  const auto column = static_cast<std::int32_t>(std::floor(u));
  const auto row = static_cast<std::int32_t>(std::floor(v));
  if (noise.cell_value(column, row, layer) > density) return 0.0F;
  const float radius = 0.2F + 0.2F * noise.cell_value(column, row, layer + 1U);
  const float middle_u =
      static_cast<float>(column) + 0.3F + 0.4F * noise.cell_value(column, row, layer + 2U);
  const float middle_v =
      static_cast<float>(row) + 0.3F + 0.4F * noise.cell_value(column, row, layer + 3U);
  const float distance = std::hypot(u - middle_u, v - middle_v);
  const float soft = std::max(0.5F * footprint / cell, 0.05F);
  const float cover = 1.0F - ease_between(radius - soft, radius + soft, distance);
  return cover * std::min(1.0F, 0.3F / soft);
}

}  // namespace

GroundSample GroundModel::grass(const GroundSpot& spot, const Nearby& nearby) const {
  const auto part = [&](float cell, int octaves, std::uint32_t layer, float fall = 0.5F) {
    return noise_.fractal(spot.x, spot.y, cell, octaves, layer, spot.footprint, fall);
  };
  const float meadow = part(23.0F, 3, kMeadow);
  const float dry = ease_between(-0.2F, 0.9F, part(11.0F, 5, kDryness, 0.65F) + 0.2F * meadow);
  const float tufts = part(1.3F, 4, kTufts, 0.75F);
  const float blades = part(0.12F, 4, kBlades, 0.85F);
  const float clover = ease_between(0.35F, 0.6F, part(3.1F, 5, kClover, 0.6F));
  float bare = ease_between(0.55F, 0.85F, part(5.3F, 5, kSoil, 0.6F));
  float shade = 0.0F;
  for (const Tree* tree : nearby.trees) {
    const auto distance = static_cast<float>((tree->at - spot.point).norm() / tree->crown);
    bare = std::max(bare, 0.8F * (1.0F - ease_between(0.1F, 0.75F, distance + 0.3F * tufts)));
    shade = std::max(shade, 1.0F - ease_between(0.4F, 1.3F, distance));
  }
  if (spot.path != nullptr) {
    const auto edge = static_cast<float>(spot.path_outside);
    bare = std::max(bare, 0.55F * (1.0F - ease_between(0.0F, 0.45F, edge + 0.35F * tufts)));
  }
  Rgb colour = blend({0.070F, 0.105F, 0.030F}, {0.200F, 0.180F, 0.085F}, 0.85F * dry);
  colour = blend(colour, {0.045F, 0.095F, 0.030F}, 0.75F * clover);
  colour = blend(colour, {0.165F, 0.120F, 0.078F}, 0.85F * bare);
  colour *= 1.0F + 0.16F * meadow + 0.30F * tufts + 0.42F * blades * (1.0F - 0.5F * bare);
  const float weeds =
      scattered(noise_, spot.x, spot.y, 0.31F, 0.10F + 0.2F * clover, kWeeds, spot.footprint);
  colour = blend(colour, {0.090F, 0.150F, 0.040F}, 0.7F * weeds);
  if (shade > 0.0F) {
    const float litter =
        scattered(noise_, spot.x, spot.y, 0.09F, 0.35F * shade, kLitter, spot.footprint);
    colour = blend(colour, {0.210F, 0.130F, 0.050F}, 0.8F * litter);
  }
  return {colour.cwiseMax(0.012F), 1.0F - 0.9F * bare};
}

GroundSample GroundModel::asphalt(const GroundSpot& spot, const Nearby& nearby) const {
  const auto part = [&](float x, float y, float cell, int octaves, std::uint32_t layer,
                        float fall = 0.5F) {
    return noise_.fractal(x, y, cell, octaves, layer, spot.footprint, fall);
  };
  const bool street = spot.road != nullptr && spot.road->kind == RoadKind::kStreet &&
                      spot.road_outside < 0.0 && spot.second_outside > 0.5;
  float tone = 0.135F;
  tone *= 1.0F + 0.17F * part(spot.x, spot.y, 17.0F, 4, kAge, 0.6F);
  if (street) {
    const auto along = static_cast<float>(spot.road_at.along);
    const auto across = static_cast<float>(spot.road_at.across);
    const float lane = std::abs(across) - 0.5F * static_cast<float>(spot.road->half_width);
    const float wheels = std::exp(-std::pow((std::abs(lane) - 0.75F) / 0.25F, 2.0F));
    const float drips = std::exp(-std::pow(lane / 0.3F, 2.0F));
    tone *= 1.0F + 0.10F * wheels - 0.10F * drips;
    tone *= 1.0F + 0.16F * part(along, 5.0F * across, 11.0F, 5, kWear, 0.6F);
    tone *= 1.0F - 0.2F * strip_share(across, 0.02F, 0.06F, std::max(0.02F, spot.footprint));
  }
  const float gutter = 1.0F - ease_between(0.0F, 0.5F, -static_cast<float>(spot.carriageway));
  const float stains = part(spot.x, spot.y, 2.7F, 6, kStain, 0.68F);
  tone *= 1.0F + 0.20F * stains - 0.22F * gutter * (1.0F + stains);
  tone *= 1.0F + 0.26F * part(spot.x, spot.y, 0.034F, 2, kGrain, 1.0F);
  tone *= 1.0F - cracks(spot);
  Rgb colour = Rgb(1.02F, 1.0F, 0.96F) * std::max(tone, 0.02F);
  const float white = paint(spot, nearby);
  if (white > 0.0F) {
    const float dirt = 1.0F + 0.16F * stains + 0.08F * part(spot.x, spot.y, 0.05F, 3, kGrain, 0.8F);
    colour = blend(colour, Rgb(0.60F, 0.60F, 0.57F) * dirt, white);
  }
  float plants = 0.0F;
  for (const Tree* tree : nearby.trees) {
    const auto distance = static_cast<float>((tree->at - spot.point).norm() / tree->crown);
    const float litter =
        scattered(noise_, spot.x, spot.y, 0.08F,
                  0.10F * (1.0F - ease_between(0.6F, 1.5F, distance)), kLitter, spot.footprint);
    colour = blend(colour, {0.23F, 0.15F, 0.05F}, 0.8F * litter);
    plants = std::max(plants, litter);
  }
  return {colour, plants};
}

GroundSample GroundModel::paving(const GroundSpot& spot, float slab_length,
                                 float slab_width) const {
  // Rows follow the road or the path that they belong to.
  const bool on_path = spot.path != nullptr && spot.path_outside < 0.3;
  const PathPoint at = on_path                ? spot.path_at
                       : spot.road != nullptr ? spot.road_at
                                              : PathPoint{spot.point.x(), spot.point.y()};
  const auto along = static_cast<float>(at.along) / slab_length;
  const auto across = static_cast<float>(at.across) / slab_width;
  const auto row = static_cast<std::int32_t>(std::floor(across));
  const float shifted = along + ((row & 1) != 0 ? 0.5F : 0.0F);
  const auto column = static_cast<std::int32_t>(std::floor(shifted));
  const float u = shifted - static_cast<float>(column);
  const float v = across - static_cast<float>(row);
  const float to_joint =
      std::min(std::min(u, 1.0F - u) * slab_length, std::min(v, 1.0F - v) * slab_width);
  const float soft = std::max(0.5F * spot.footprint, 0.004F);
  const float joint =
      (1.0F - ease_between(0.006F - soft, 0.006F + soft, to_joint)) * std::min(1.0F, 0.02F / soft);
  const float slab = noise_.cell_value(column, row, kSlabs) - 0.5F;
  const float seen = std::clamp(slab_width / spot.footprint - 1.0F, 0.0F, 1.0F);
  const float stain = noise_.fractal(spot.x, spot.y, 3.7F, 7, kSlabStain, spot.footprint, 0.65F);
  const float grain = noise_.fractal(spot.x, spot.y, 0.06F, 3, kSlabGrain, spot.footprint, 0.8F);
  const float moss = joint * ease_between(-0.1F, 0.5F, stain);
  Rgb colour = Rgb(0.275F, 0.262F, 0.238F) *
               (1.0F + 0.26F * slab * seen + 0.26F * stain + 0.14F * grain - 0.55F * joint);
  colour = blend(colour, {0.07F, 0.10F, 0.04F}, 0.6F * moss);
  return {colour.cwiseMax(0.02F), 0.4F * moss};
}

GroundSample GroundModel::gravel(const GroundSpot& spot) const {
  const float stain = noise_.fractal(spot.x, spot.y, 2.3F, 6, kStain, spot.footprint, 0.65F);
  const float pebbles = noise_.fractal(spot.x, spot.y, 0.07F, 3, kPebbles, spot.footprint, 0.9F);
  const float light = scattered(noise_, spot.x, spot.y, 0.05F, 0.3F, kPebbles, spot.footprint);
  const Rgb colour =
      Rgb(0.25F, 0.215F, 0.165F) * (1.0F + 0.22F * stain + 0.34F * pebbles + 0.25F * light);
  return {colour.cwiseMax(0.03F), 0.0F};
}

GroundSample GroundModel::crop(const GroundSpot& spot, const Area& area) const {
  const Eigen::Vector2d p = area.local(spot.point);
  const auto across = static_cast<float>(p.y());
  const float wander = 0.05F * noise_.fractal(spot.x, spot.y, 4.0F, 2, kRows, spot.footprint);
  constexpr float kRowSpacing = 0.75F;
  const float phase = (across + wander) / kRowSpacing;
  const float in_row = std::abs(phase - std::floor(phase) - 0.5F) * kRowSpacing;
  const float seen = std::clamp(0.5F * kRowSpacing / spot.footprint - 0.5F, 0.0F, 1.0F);
  const float vigour =
      0.5F + 0.5F * noise_.fractal(spot.x, spot.y, 9.0F, 5, kDryness, spot.footprint, 0.6F);
  const float leaves = noise_.fractal(spot.x, spot.y, 0.18F, 4, kLeaf, spot.footprint, 0.8F);
  const float width = 0.10F + 0.2F * vigour + 0.12F * leaves;
  const float soft = std::max(0.03F, 0.5F * spot.footprint);
  const float row = 1.0F - ease_between(width - soft, width + soft, in_row);
  const float cover = seen * row + (1.0F - seen) * std::clamp(2.6F * width, 0.0F, 1.0F);
  const float clods = noise_.fractal(spot.x, spot.y, 0.4F, 5, kSoil, spot.footprint, 0.75F);
  const Rgb soil = Rgb(0.150F, 0.108F, 0.072F) * (1.0F + 0.35F * clods);
  const Rgb plant = blend({0.060F, 0.120F, 0.028F}, {0.130F, 0.155F, 0.050F}, 1.0F - vigour) *
                    (1.0F + 0.45F * leaves);
  return {blend(soil, plant, cover).cwiseMax(0.015F), cover};
}

GroundSample GroundModel::bed(const GroundSpot& spot) const {
  const float clods = noise_.fractal(spot.x, spot.y, 0.5F, 6, kSoil, spot.footprint, 0.75F);
  const float leaves = noise_.fractal(spot.x, spot.y, 0.3F, 4, kLeaf, spot.footprint, 0.8F);
  const float cover = ease_between(0.0F, 0.25F, leaves);
  const Rgb soil = Rgb(0.10F, 0.072F, 0.05F) * (1.0F + 0.4F * clods);
  const Rgb plant = Rgb(0.055F, 0.10F, 0.035F) * (1.0F + 0.5F * leaves);
  return {blend(soil, plant, cover).cwiseMax(0.012F), cover};
}

GroundSample GroundModel::area_surface(const GroundSpot& spot, const Area& area,
                                       const Nearby& nearby) const {
  switch (area.kind) {
    case AreaKind::kPlaza:
      return paving(spot, 1.0F, 0.5F);
    case AreaKind::kGravelYard:
      return gravel(spot);
    case AreaKind::kCrop:
      return crop(spot, area);
    case AreaKind::kBed:
      return bed(spot);
    case AreaKind::kParking:
      return asphalt(spot, nearby);
  }
  return grass(spot, nearby);
}

GroundSample kerb_stone(const GroundSpot& spot, const ValueNoise& noise) {
  const float along =
      spot.road == nullptr ? spot.x + spot.y : static_cast<float>(spot.road_at.along);
  const float u = along - std::floor(along);
  const float soft = std::max(0.5F * spot.footprint, 0.006F);
  const float joint = (1.0F - ease_between(0.008F - soft, 0.008F + soft, std::min(u, 1.0F - u))) *
                      std::min(1.0F, 0.02F / soft);
  const float stone =
      noise.cell_value(static_cast<std::int32_t>(std::floor(along)), 0, kKerbStain) - 0.5F;
  const float stain = noise.fractal(spot.x, spot.y, 0.9F, 6, kKerbStain, spot.footprint, 0.7F);
  const Rgb colour =
      Rgb(0.335F, 0.325F, 0.300F) * (1.0F + 0.2F * stone + 0.25F * stain - 0.5F * joint);
  return {colour.cwiseMax(0.03F), 0.0F};
}

}  // namespace nadir::simulation
