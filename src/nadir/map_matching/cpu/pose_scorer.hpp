// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/cpu/sums.hpp"
#include "nadir/map_matching/matching.hpp"
#include "nadir/map_matching/quads.hpp"

namespace nadir::cpu {

/// The pixels of a template that take part, as one list: where they are relative to the robot, in
/// map pixels (x right, y up), and what they add to the sums.
struct PixelList {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> a;   ///< weight in the sums
  std::vector<float> p;   ///< a P'
  std::vector<float> pp;  ///< a P'^2
  std::vector<float> wp;  ///< w P / 64, unshifted; for wncc alone, else empty
  double total_seen = 0.0;
  Shifts shifts;
};
PixelList list_pixels(const ChannelImage& local, const MatchingOptions& options,
                      double map_resolution, double map_shift);

/// A pose in map pixels: the robot's continuous pixel coordinate (pixel centres at integers) and
/// its heading.
struct PixelPose {
  double column = 0.0;
  double row = 0.0;
  double cosine = 1.0;
  double sine = 0.0;
};

/// The sums of one pose: the map is sampled (bilinear) under every pixel of the list. Runs on the
/// widest vectors that the processor has.
Sums sum_at(const Quads& map, const PixelList& pixels, const PixelPose& pose);

}  // namespace nadir::cpu
