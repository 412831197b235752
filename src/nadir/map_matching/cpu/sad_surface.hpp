// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/cpu/region.hpp"

namespace nadir::cpu {

/// Surfaces of the mean absolute difference, by direct summation: |R - P| has no transform.
std::vector<ScoreSurface> sad_surfaces(const MatchingOptions& options, const Region& region,
                                       std::span<const RotatedTemplate> templates,
                                       const PixelWindow& window, const StopToken& stop);

}  // namespace nadir::cpu
