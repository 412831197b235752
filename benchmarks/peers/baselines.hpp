// SPDX-License-Identifier: Apache-2.0
// What our matching is compared with. Everything works on one thread.
#pragma once

#include <span>
#include <vector>

#include "nadir/map_matching/rotated_template.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir::bench {

/// Table I of the paper: a score at every `stride`-th position at which the template lies within
/// the map, by four nested loops in double as they are written down, compiled with -O2. Holes of
/// both sides are left out; the weight is equation [4] with normalised distances.
enum class BruteForce { kSad, kSsd, kNcc, kWncc, kWnccTable };  // the last: weights from a table
std::vector<double> brute_force(BruteForce score, const ChannelImage& map,
                                const ChannelImage& local, int stride);
std::size_t brute_force_positions(const ChannelImage& map, const ChannelImage& local, int stride);

/// The authors' way with one particle: turn the local map by warpAffine, then compare it with the
/// map around the particle's pixel in a loop; here with zwncc, so that results can be compared.
std::vector<double> warp_and_loop(const ChannelImage& map, const ChannelImage& local,
                                  std::span<const Pose2> poses, double min_valid_weight);

/// zwncc of the whole map, robot on every pixel, from six TM_CCORR of OpenCV.
ScoreSurface six_ccorr(const ChannelImage& map, const RotatedTemplate& local,
                       double min_valid_weight, double map_shift);

/// TM_CCOEFF_NORMED of OpenCV with a mask (sqrt of the weights, as it squares them) on the same
/// positions; it knows no mask of the map. Without a mask where `masked` is off.
Raster<float> opencv_coeff(const ChannelImage& map, const RotatedTemplate& local, bool masked);

}  // namespace nadir::bench
