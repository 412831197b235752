// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/cpu/region.hpp"

namespace nadir::cpu {

/// Surfaces of equation [5] as printed, exactly, by FFT. For an 8-bit map the numerator
/// sum w |R - mu| |P - Pm| is linear in mu between two integers, so that two correlations, at the
/// integers below and above the window's mean, give it without error. Only the levels that occur as
/// window means are correlated.
std::vector<ScoreSurface> paper_surfaces(const MatchingOptions& options, const Region& region,
                                         std::span<const RotatedTemplate> templates,
                                         const PixelWindow& window, const StopToken& stop);

}  // namespace nadir::cpu
