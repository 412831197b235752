// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/elevation_map.hpp"
#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// Derives from heights the image that is compared, at `options.resolution_m` (docs/height.md):
/// the height above the ground nearby, compressed to 8 bits, 128 = ground. It depends on neither
/// the datum nor the slope, so that heights above the robot's wheels compare with heights above the
/// sea. `what` names the heights in errors. Throws Error (input) for an empty raster.
ChannelImage make_height_channel(const ElevationMap& heights, const MatchingOptions& options,
                                 const std::string& what);

}  // namespace nadir
