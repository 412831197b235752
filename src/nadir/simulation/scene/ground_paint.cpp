// SPDX-License-Identifier: Apache-2.0
// What lies on the asphalt: cracks, markings, covers and repairs.
#include <algorithm>
#include <cmath>

#include "nadir/simulation/scene/ground_spot.hpp"

namespace nadir::simulation {
namespace {

constexpr float kDashPeriod = 7.0F;
constexpr float kDashLength = 3.0F;
constexpr float kZebraHalfLength = 1.6F;
constexpr float kArrowLength = 4.0F;

float line(float value, float middle, float width, float soft) {
  return strip_share(value, middle - 0.5F * width, middle + 0.5F * width, soft);
}

/// Markings of a street, before wear: 1 = white.
float street_lines(const Road& road, const PathPoint& at, float soft) {
  const auto along = static_cast<float>(at.along);
  const auto across = static_cast<float>(at.across);
  const float side = std::abs(across);
  const auto half = static_cast<float>(road.half_width);
  const float dash = along - kDashPeriod * std::floor(along / kDashPeriod);
  float centre = strip_share(dash, 0.05F, kDashLength, soft);
  float share = line(side, half - 0.30F, 0.12F, soft);
  for (const double middle : road.crossings) {
    const float offset = along - static_cast<float>(middle);
    const float distance = std::abs(offset);
    if (distance > kZebraHalfLength + 14.0F) continue;
    if (distance < kZebraHalfLength + 12.0F) centre = 1.0F;  // no overtaking before a crossing
    if (distance < kZebraHalfLength + 1.2F) centre = 0.0F;
    const float stripe = std::abs(across - 0.5F - std::round(across - 0.5F));
    const float zebra = strip_share(distance, -1.0F, kZebraHalfLength, soft) *
                        strip_share(stripe, -1.0F, 0.25F, soft) *
                        strip_share(side, -1.0F, half - 0.4F, soft);
    if (distance < kZebraHalfLength + soft) share = 0.0F;
    const float ahead = across < 0.0F ? -offset : offset;  // traffic keeps to the right
    const float stop = line(ahead, kZebraHalfLength + 1.25F, 0.4F, soft) *
                       strip_share(side, 0.15F, half - 0.4F, soft);
    share = std::max({share, zebra, stop});
  }
  return std::max(share, centre * line(across, 0.0F, 0.12F, soft));
}

/// Markings of a parking area: the lines between its stalls.
float stall_lines(const Area& area, const Eigen::Vector2d& point, float soft) {
  const Eigen::Vector2d p = area.local(point);
  const auto u = static_cast<float>(p.x() + area.half_length);
  const auto from_edge = static_cast<float>(area.half_width - std::abs(p.y()));
  const auto width = static_cast<float>(kStallWidth);
  const float offset = u - width * std::round(u / width);
  return line(offset, 0.0F, 0.1F, soft) *
         strip_share(from_edge, 0.1F, static_cast<float>(kStallDepth), soft);
}

/// An arrow 4 m long that points along x, its tail at (0, 0).
float arrow_share(float x, float y, float soft) {
  const float side = std::abs(y);
  const float shaft = strip_share(x, 0.0F, 2.5F, soft) * strip_share(side, -1.0F, 0.08F, soft);
  const float head = strip_share(x, 2.5F, kArrowLength, soft) *
                     strip_share(side, -1.0F, 0.34F * (kArrowLength - x) / 1.5F, soft);
  return std::max(shaft, head);
}

struct Relative {
  float x = 0.0F;
  float y = 0.0F;
};

Relative relative_to(const Decal& decal, const Eigen::Vector2d& point) {
  const double c = std::cos(decal.yaw);
  const double s = std::sin(decal.yaw);
  const Eigen::Vector2d offset = point - decal.at;
  return {static_cast<float>(c * offset.x() + s * offset.y()),
          static_cast<float>(-s * offset.x() + c * offset.y())};
}

}  // namespace

float GroundModel::cracks(const GroundSpot& spot) const {
  const float place = noise_.fractal(spot.x, spot.y, 9.0F, 3, kCrackPlace, spot.footprint);
  if (place < -0.05F) return 0.0F;
  // A crack runs along a line of equal value of a warped, smooth field.
  const float warp = 0.25F * noise_.fractal(spot.x, spot.y, 0.7F, 3, kCrackLine, spot.footprint);
  const float field = noise_.at(spot.x + warp, spot.y - warp, 4.6F, kCrackLine + 1000U);
  const float distance = std::abs(field) * 3.0F;  // metres, for a typical slope
  const float soft = std::max(0.5F * spot.footprint, 0.004F);
  const float open = (1.0F - ease_between(0.006F, 0.010F + soft, distance)) *
                     std::min(1.0F, 0.012F / soft) * ease_between(-0.05F, 0.15F, place);
  const float sealed =
      (1.0F - ease_between(0.04F, 0.05F + soft, distance)) * ease_between(0.42F, 0.46F, place);
  return std::max(0.75F * open, 0.45F * sealed);
}

float GroundModel::paint(const GroundSpot& spot, const Nearby& nearby) const {
  const float soft = std::max(0.5F * spot.footprint, 0.006F);
  float share = 0.0F;
  if (spot.road != nullptr && spot.road->kind == RoadKind::kStreet && spot.road_outside < 0.0 &&
      spot.second_outside > 3.0) {
    share = street_lines(*spot.road, spot.road_at, soft);
  }
  if (spot.area != nullptr && spot.area->kind == AreaKind::kParking && spot.area_outside < 0.0 &&
      spot.road_outside > 0.0) {
    share = std::max(share, stall_lines(*spot.area, spot.point, soft));
  }
  for (const Decal* decal : nearby.decals) {
    if (decal->kind != DecalKind::kArrow) continue;
    const Relative at = relative_to(*decal, spot.point);
    share = std::max(share, arrow_share(at.x, at.y, soft));
  }
  if (share <= 0.0F) return 0.0F;
  const float wear = noise_.fractal(spot.x, spot.y, 2.1F, 5, kPaintWear, spot.footprint, 0.6F);
  const float flakes = noise_.fractal(spot.x, spot.y, 0.06F, 3, kPaintFlakes, spot.footprint, 0.8F);
  return share * (0.93F - 0.55F * ease_between(0.0F, 0.9F, wear + 0.6F * flakes));
}

void GroundModel::add_decals(const GroundSpot& spot, const Nearby& nearby,
                             GroundSample& sample) const {
  const float soft = std::max(0.5F * spot.footprint, 0.006F);
  for (const Decal* decal : nearby.decals) {
    const Relative at = relative_to(*decal, spot.point);
    const float u = std::abs(at.x) - static_cast<float>(decal->half_length);
    const float v = std::abs(at.y) - static_cast<float>(decal->half_width);
    const float outside = std::max(u, v);
    if (decal->kind == DecalKind::kPatch) {
      if (outside > 0.1F || spot.carriageway > -0.1) continue;
      const float inside = 1.0F - ease_between(-soft, soft, outside);
      sample.albedo *= 1.0F + decal->tone * inside;
      sample.albedo *= 1.0F - 0.5F * strip_share(outside, -0.035F, 0.035F, soft);
      continue;
    }
    if (decal->kind == DecalKind::kManhole) {
      const float radius = std::hypot(at.x, at.y);
      const auto outer = static_cast<float>(decal->half_length);
      if (radius > outer + 0.12F) continue;
      const float rust = noise_.fractal(spot.x, spot.y, 0.3F, 4, kRust, spot.footprint);
      const float studs = std::cos(at.x * 90.0F) * std::cos(at.y * 90.0F) *
                          std::clamp(0.035F / spot.footprint - 0.5F, 0.0F, 1.0F);
      const Eigen::Vector3f iron =
          Eigen::Vector3f(0.085F, 0.075F, 0.066F) * (1.0F + 0.4F * rust + 0.5F * studs);
      const float ring = strip_share(radius, outer - 0.05F, outer + 0.03F, soft);
      const float cover = 1.0F - ease_between(-soft, soft, radius - outer);
      sample.albedo += cover * (iron - sample.albedo);
      sample.albedo += 0.75F * ring * (Eigen::Vector3f(0.2F, 0.19F, 0.175F) - sample.albedo);
      continue;
    }
    if (decal->kind == DecalKind::kDrain) {
      if (outside > soft) continue;
      const float bar = std::cos(at.x * 100.0F) * std::clamp(0.03F / spot.footprint, 0.0F, 1.0F);
      const Eigen::Vector3f grate = Eigen::Vector3f(0.055F, 0.052F, 0.05F) * (1.0F + 0.7F * bar);
      sample.albedo += (1.0F - ease_between(-soft, soft, outside)) * (grate - sample.albedo);
    }
  }
}

}  // namespace nadir::simulation
