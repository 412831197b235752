// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/surface.hpp"

namespace nadir::cpu {

/// Surfaces of all scores that are closed forms of sums (score_from_sums), by FFT: six correlations
/// a heading against three spectra of the map. Works in tiles of bounded size and on as many
/// headings at once as 256 MiB allow.
std::vector<ScoreSurface> closed_form_surfaces(const MapIndex& map,
                                               std::span<const RotatedTemplate> templates,
                                               const PixelWindow& window, const StopToken& stop);

}  // namespace nadir::cpu
