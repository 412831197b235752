// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/matching.hpp"

namespace nadir {

/// The channel at half the resolution: area average of the valid pixels.
ChannelImage halved(const ChannelImage& channel);

/// Candidates from coarse to fine: `volume` was scored on `map` at a quarter of the resolution with
/// `quarter`; the best places are scored around at half the resolution, the best of those at
/// full resolution, and climbed. Best first, separated as the options say.
std::vector<MatchCandidate> refine_coarse(const MapIndex& map, const Template& local,
                                          const ScoreVolume& volume, const StopToken& stop);

/// Step between headings at which the edge of a template moves by about one pixel of a quarter of
/// the resolution: 3 degrees for 18 m.
double coarse_yaw_step(const ChannelImage& local, double resolution);

}  // namespace nadir
