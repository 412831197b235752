// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/cpu/region.hpp"

namespace nadir::cpu {

/// Surfaces of all scores that are closed forms of sums (score_from_sums), by FFT: six correlations
/// a heading against three spectra of the map.
std::vector<ScoreSurface> closed_form_surfaces(const MatchingOptions& options, const Region& region,
                                               std::span<const RotatedTemplate> templates,
                                               const PixelWindow& window);

}  // namespace nadir::cpu
