// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/ortho/orthomosaic.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#ifdef NADIR_HAS_SFM
#include "nadir/aerial_mapping/sfm/reconstruction.hpp"
#endif

namespace nadir::aerial {

/// Poses of the map, and what the report says of each photo that follows from them and the ground.
void fill_views(const PhotoSet& set, const Block& block, const Ground& ground, AerialMap& map);

#ifdef NADIR_HAS_SFM
/// Views and surface points of the mapped group.
Block block_of(const Reconstruction& found);

/// What the adjustment says: errors, residuals, groups, cameras, doubts.
void fill_report(const PhotoSet& set, const Reconstruction& found,
                 const std::vector<VerifiedPair>& pairs, const AerialMappingOptions& options,
                 AdjustmentReport& report);
#endif

}  // namespace nadir::aerial
