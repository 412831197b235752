// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/ground_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nadir/simulation/scene/ground_spot.hpp"

namespace nadir::simulation {
namespace {

constexpr double kFar = 1e3;

double reach_of(const Decal& decal) {
  return std::hypot(decal.half_length, decal.half_width) + 0.2;
}

bool is_carriageway(const Road& road) {
  return road.kind == RoadKind::kStreet || road.kind == RoadKind::kLane;
}

}  // namespace

GroundModel::GroundModel(std::uint64_t seed, const Layout& layout, double relief_m,
                         Eigen::Vector2d low, Eigen::Vector2d high)
    : noise_(seed),
      layout_(layout),
      relief_m_(relief_m),
      low_(std::move(low)),
      high_(std::move(high)) {}

Nearby GroundModel::near(const Eigen::Vector2d& point, double reach) const {
  Nearby nearby;
  for (const Road& road : layout_.roads) {
    const double verge = kPavementWidth + 2.0 * kCornerRadius;
    if (std::abs(road.path.locate(point).across) < road.half_width + verge + reach) {
      nearby.roads.push_back(&road);
    }
  }
  for (const Area& area : layout_.areas) {
    if (area.outside(point) < reach + 4.0) nearby.areas.push_back(&area);
  }
  for (const Decal& decal : layout_.decals) {
    if ((decal.at - point).norm() < reach + reach_of(decal)) nearby.decals.push_back(&decal);
  }
  for (const Tree& tree : layout_.trees) {
    if ((tree.at - point).norm() < reach + tree.crown + 1.0) nearby.trees.push_back(&tree);
  }
  return nearby;
}

/// Gentle hills that fade out towards the edge of the world, where it goes on as a plane.
double GroundModel::relief(const Eigen::Vector2d& point) const {
  const double edge = std::min((point - low_).minCoeff(), (high_ - point).minCoeff());
  if (edge <= 0.0 || relief_m_ == 0.0) return 0.0;
  const double fade = std::min(edge / 20.0, 1.0);
  const auto x = static_cast<float>(point.x());
  const auto y = static_cast<float>(point.y());
  return relief_m_ * fade * fade * (3.0 - 2.0 * fade) *
         (0.75 * noise_.at(x, y, 45.0F, kHills) + 0.25 * noise_.at(x, y, 17.0F, kHillsFine));
}

GroundSpot GroundModel::locate(const Eigen::Vector2d& point, float footprint,
                               const Nearby& nearby) {
  GroundSpot spot;
  spot.point = point;
  spot.x = static_cast<float>(point.x());
  spot.y = static_cast<float>(point.y());
  spot.footprint = footprint;
  spot.carriageway = kFar;
  spot.kerbed = kFar;
  for (const Road* road : nearby.roads) {
    const PathPoint at = road->path.locate(point);
    const double outside = std::abs(at.across) - road->half_width;
    if (!is_carriageway(*road)) {
      if (outside < spot.path_outside) {
        spot.path = road;
        spot.path_at = at;
        spot.path_outside = outside;
      }
      continue;
    }
    if (outside < spot.road_outside) {
      spot.second_outside = spot.road_outside;
      spot.road = road;
      spot.road_at = at;
      spot.road_outside = outside;
    } else {
      spot.second_outside = std::min(spot.second_outside, outside);
    }
    spot.carriageway = rounded_union(spot.carriageway, outside, kCornerRadius);
    if (road->kind == RoadKind::kStreet) {
      spot.kerbed = rounded_union(spot.kerbed, outside, kCornerRadius);
    }
  }
  for (const Area* area : nearby.areas) {
    const double outside = area->outside(point);
    if (area->kind == AreaKind::kParking) {
      spot.carriageway = rounded_union(spot.carriageway, outside, 1.5);
    }
    if (outside < spot.area_outside) {
      spot.area = area;
      spot.area_outside = outside;
    }
  }
  return spot;
}

double GroundModel::height(const GroundSpot& spot) const {
  const double base = relief(spot.point);
  if (!layout_.painted) return base;
  const double outside = spot.carriageway;
  if (outside > 0.0) {
    // Pavements rise away from the kerb; lawns are never quite even.
    const double rise = 0.02 * std::min(outside, kPavementWidth);
    if (outside < kPavementWidth || spot.path_outside < 0.3) return base + rise;
    return base + rise + 0.02 * noise_.at(spot.x, spot.y, 0.9F, kBumps);
  }
  // The carriageway lies below the kerb and is cambered, 2.5 %, towards its gutters.
  const double inside = std::min(-outside, 3.5);
  const double face = std::min(-outside / kKerbFace, 1.0);
  return base + 0.025 * (inside - 1.75) * (spot.kerbed < 0.0 ? 1.0 : 0.0) - kKerbHeight * face;
}

GroundSample GroundModel::sample(const GroundSpot& spot, const Nearby& nearby) const {
  const float footprint = spot.footprint;
  const float soft = std::max(0.5F * footprint, 0.008F);
  const auto outside = static_cast<float>(spot.carriageway);
  GroundSample sample;
  const auto face = static_cast<float>(kKerbFace);
  if (outside < -soft - face) {
    sample = asphalt(spot, nearby);
  } else {
    const bool paved = spot.kerbed < kPavementWidth + 0.3 && outside < kPavementWidth + 0.3F;
    const auto to_pavement = static_cast<float>(kPavementWidth);
    if (!paved || outside > to_pavement - 0.3F) {
      sample = spot.area != nullptr && spot.area_outside < 0.0
                   ? area_surface(spot, *spot.area, nearby)
                   : grass(spot, nearby);
      if (spot.path != nullptr && spot.path_outside < 0.4) {
        // Grass creeps over the edge of a path.
        const float creep = 0.12F * noise_.fractal(spot.x, spot.y, 0.6F, 3, kCreep, footprint);
        const float share =
            1.0F - ease_between(-soft, soft + 0.03F, static_cast<float>(spot.path_outside) + creep);
        if (share > 0.0F) {
          const GroundSample on_path =
              spot.path->kind == RoadKind::kTrack ? gravel(spot) : paving(spot, 0.6F, 0.4F);
          sample = mixed(sample, on_path, share);
        }
      }
    }
    if (paved) {
      const float creep = 0.1F * noise_.fractal(spot.x, spot.y, 0.7F, 3, kCreep, footprint);
      const float share = 1.0F - ease_between(-soft, soft + 0.04F, outside - to_pavement + creep);
      if (share > 0.0F) sample = mixed(sample, paving(spot, 0.5F, 0.5F), share);
    }
    const auto kerb = static_cast<float>(kKerbWidth);
    if (outside < kerb + soft) {
      sample = mixed(sample, kerb_stone(spot, noise_), strip_share(outside, -1.0F, kerb, soft));
    }
    if (outside < soft - face) {
      sample =
          mixed(sample, asphalt(spot, nearby), 1.0F - ease_between(-soft, soft, outside + face));
    }
  }
  add_decals(spot, nearby, sample);
  return sample;
}

}  // namespace nadir::simulation
