// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/orthomosaic.hpp"
#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// Derives the channel of `options` from an orthomosaic, at `options.resolution_m`. `what` names
/// the image in errors. Throws Error (input) for an empty image or a mask of another size.
ChannelImage make_channel(const Orthomosaic& orthomosaic, const MatchingOptions& options,
                          const std::string& what);

}  // namespace nadir
