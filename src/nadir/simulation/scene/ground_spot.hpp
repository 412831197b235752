// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/simulation/scene/ground_model.hpp"

namespace nadir::simulation {

/// One layer of noise a purpose: equal layers would show the same blotches twice.
enum GroundLayer : std::uint32_t {
  kHills = 1,
  kHillsFine,
  kBumps,
  kMeadow,
  kDryness,
  kTufts,
  kBlades,
  kSoil,
  kClover,
  kWeeds,
  kLitter,
  kStain,
  kGrain,
  kWear,
  kAge,
  kCrackLine,
  kCrackPlace,
  kSeal,
  kPaintWear,
  kPaintFlakes,
  kSlabs,
  kSlabStain,
  kSlabGrain,
  kKerbStain,
  kPebbles,
  kCreep,
  kRows,
  kLeaf,
  kOil,
  kRust,
};

struct GroundSpot {
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
  float x = 0.0F;
  float y = 0.0F;
  float footprint = 0.05F;
  double carriageway = 1e3;  ///< distance from all asphalt together; negative on it
  double kerbed = 1e3;       ///< distance from the streets
  const Road* road = nullptr;
  PathPoint road_at;
  double road_outside = 1e3;
  double second_outside = 1e3;  ///< of the next road: small within a junction
  const Road* path = nullptr;   ///< the nearest footway or track
  PathPoint path_at;
  double path_outside = 1e3;
  const Area* area = nullptr;
  double area_outside = 1e3;
};

inline GroundSample mixed(const GroundSample& from, const GroundSample& to, float share) {
  return {from.albedo + share * (to.albedo - from.albedo),
          from.plants + share * (to.plants - from.plants)};
}

GroundSample kerb_stone(const GroundSpot& spot, const ValueNoise& noise);

}  // namespace nadir::simulation
