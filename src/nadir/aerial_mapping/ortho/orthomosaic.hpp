// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/mapping.hpp"
#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/ortho/views.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// A height above the ground, and what the limits on rays follow from.
struct Block {
  std::vector<View> views;
  std::vector<Eigen::Vector3d> points;  ///< triangulated
  double ground = 0.0;                  ///< their mean height, or what is known of it
  /// By which a point may stand out from its neighbours in any case: 1 % of the flying height.
  double outlier_tolerance() const;
};

/// Adds points where features gave none and the photos agree on a height. Throws Stopped.
void sweep_for_points(const PhotoSet& set, Block& block, const AerialMappingOptions& options,
                      const StopToken& stop);

/// The area that the points reach, or, without any, the photos on a plane.
Extent extent_of(const Block& block, const AerialMappingOptions& options);

Ground ground_of(const Block& block, const Extent& extent, const AerialMappingOptions& options);

ViewLimits limits_of(const Block& block, const AerialMappingOptions& options);

/// Fills the rasters of the map, and the gains in the views. Throws Error (usage) where it would
/// be larger than the options allow, and Stopped.
void make_orthomosaic(const PhotoSet& set, Block& block, const Ground& ground, const Extent& extent,
                      const AerialMappingOptions& options, const MappingProgress& progress,
                      const StopToken& stop, AerialMap& map);

}  // namespace nadir::aerial
