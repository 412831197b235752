// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// The best places of a volume, best first: local maxima over position and heading, refined below
/// the pixel and the yaw step by parabolas, each at least `peak_separation_m` from every better
/// one. At most `candidates` of them; none where no score is defined.
std::vector<MatchCandidate> find_peaks(const ScoreVolume& volume, const MatchingOptions& options);

/// Climbs from a candidate to the maximum of the exact score beside it, by Newton steps on a
/// quadratic through the scores around it. The heading stays where `turn` is off. Returns the
/// candidate itself where no better pose is found.
MatchCandidate climb(const MapIndex& map, const Template& local, const MatchCandidate& candidate,
                     bool turn, const StopToken& stop);

/// See MatchResult::peak_ratio.
double peak_ratio(const ScoreVolume& volume, const std::vector<MatchCandidate>& candidates);

}  // namespace nadir
