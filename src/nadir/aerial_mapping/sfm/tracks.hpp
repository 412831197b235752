// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/aerial_mapping/sfm/features.hpp"
#include "nadir/aerial_mapping/sfm/matching.hpp"

namespace nadir::aerial {

/// Where a photo sees a point.
struct Observation {
  std::size_t photo = 0;
  double u = 0.0;
  double v = 0.0;
};

/// One point of the ground as several photos see it, sorted by photo, each at most once.
using Track = std::vector<Observation>;

/// Joins pairwise matches to tracks of two and more photos. A photo that a track would meet at two
/// places is taken out of it.
std::vector<Track> build_tracks(const std::vector<PhotoFeatures>& features,
                                const std::vector<VerifiedPair>& pairs);

}  // namespace nadir::aerial
