// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <vector>

#include "nadir/core/geo_reference.hpp"
#include "nadir/core/raster.hpp"

namespace nadir {

/// What stands for the score of a pose that nothing can be said of.
inline constexpr float kUndefinedScore = std::numeric_limits<float>::quiet_NaN();

/// Scores over a grid of robot positions, one surface per heading. The pose of pixel (column, row)
/// of surface k is that pixel's centre in `geo` (map frame) with the heading `yaws[k]`.
/// NaN where the score is undefined; otherwise larger is better, for every score.
struct ScoreVolume {
  GeoReference geo;
  std::vector<double> yaws;                 ///< radians, ascending, evenly spaced
  std::vector<Raster<float>> score;         ///< one per yaw
  std::vector<Raster<float>> valid_weight;  ///< share of the template's weight that was compared

  /// The best score over all headings at each position; NaN where none is defined.
  Raster<float> best_over_headings() const {
    if (score.empty()) return {};
    Raster<float> best(score.front().width(), score.front().height(), kUndefinedScore);
    for (const Raster<float>& surface : score) {
      for (std::size_t i = 0; i < best.values().size(); ++i) {
        const float value = surface.values()[i];
        float& kept = best.values()[i];
        if (!(kept >= value) && value == value) kept = value;
      }
    }
    return best;
  }
};

}  // namespace nadir
