// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// The best places of a volume, best first: local maxima over position and heading, refined below
/// the pixel and the yaw step by parabolas, each at least `peak_separation_m` from every better
/// one. At most `candidates` of them; none where no score is defined.
std::vector<MatchCandidate> find_peaks(const ScoreVolume& volume, const MatchingOptions& options);

/// See MatchResult::peak_ratio.
double peak_ratio(const ScoreVolume& volume, const std::vector<MatchCandidate>& candidates);

}  // namespace nadir
