// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/matching.hpp"
#include "nadir/map_matching/reference/scores.hpp"

namespace nadir::cpu {

/// Scores of poses that are no closed form of sums, or in which holes take part: samples the map
/// once under every pixel of the template, then applies the definition of the score.
class SampledScorer {
 public:
  SampledScorer(const MapIndex& map, const Template& local);
  PoseScore operator()(const Pose2& map_from_robot) const;

 private:
  /// A template pixel that takes part: where it is in the robot frame (metres), and what it holds.
  struct Pixel {
    double x;
    double y;
    double grey;
    double weight;
    double compared;  ///< weight in the share of what is compared; 0 for a hole
  };

  const MapIndex& map_;
  Raster<float> filled_;  ///< the map's grey; white in holes
  std::vector<Pixel> pixels_;
  double total_compared_ = 0.0;
  bool whole_square_ = false;
};

}  // namespace nadir::cpu
