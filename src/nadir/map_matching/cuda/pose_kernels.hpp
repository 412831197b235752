// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/cuda/turn_kernels.hpp"

namespace nadir::cuda {

/// The 2 x 2 neighbourhoods of the map's pixels (nadir::Quads).
struct QuadMap {
  const std::uint32_t* words = nullptr;  ///< 0 where one of the four is a hole
  /// The same with white holes; null where holes take no part.
  const std::uint32_t* white = nullptr;
  int width = 0;  ///< with the margin
  int height = 0;
};

/// A pose in map pixels. The whole part stays an integer, so that single precision is enough in any
/// map.
struct PixelPose {
  int column = 0;  ///< of the quad below the robot
  int row = 0;
  float column_part = 0.0F;
  float row_part = 0.0F;
  float cosine = 1.0F;
  float sine = 0.0F;
};

/// The pixels of a template that take part, relative to the robot, in map pixels: x right, y up.
struct SampledPixels {
  const float* x = nullptr;
  const float* y = nullptr;
  const float* value = nullptr;
  const float* weight = nullptr;
  const float* seen = nullptr;  ///< 0 where the template has a hole
  int count = 0;
};

/// Scores of poses: the map is sampled (bilinear) below every pixel. One block for each pose; its
/// threads take every kThreads-th pixel, and their sums are added as a tree.
struct ScorePoses {
  static constexpr int kThreads = 128;
  using Partial = Sums<double>;

  QuadMap map;
  SampledPixels pixels;
  const PixelPose* poses = nullptr;
  int count = 0;
  Rule rule;
  Shifts shifts;
  double total_seen = 0.0;
  PaperMoments* moments = nullptr;  ///< of [5]: written here, read by ScoreDeviations
  double* score = nullptr;
  double* share = nullptr;

  NADIR_HOST_DEVICE int blocks() const { return count; }
  NADIR_HOST_DEVICE static void merge(Partial& to, const Partial& from) { add(to, from); }

  NADIR_HOST_DEVICE Partial partial(int block, int thread) const {
    Sums<float> sums;
    switch (rule.formula) {
      case Formula::kSsd:
        sum_as<Formula::kSsd>(poses[block], thread, sums);
        break;
      case Formula::kSad:
        sum_as<Formula::kSad>(poses[block], thread, sums);
        break;
      case Formula::kCosine:
        sum_as<Formula::kCosine>(poses[block], thread, sums);
        break;
      case Formula::kWeightedCosine:
        sum_as<Formula::kWeightedCosine>(poses[block], thread, sums);
        break;
      case Formula::kPaper:
        sum_as<Formula::kPaper>(poses[block], thread, sums);
        break;
      case Formula::kZeroMean:
        sum_as<Formula::kZeroMean>(poses[block], thread, sums);
        break;
    }
    Partial result;
    add(result, sums);
    return result;
  }

  NADIR_HOST_DEVICE void finish(int block, const Partial& sums) const {
    const double compared = share_of(sums.seen, total_seen);
    share[block] = compared;
    const bool enough = is_enough(rule, compared);
    if (rule.formula != Formula::kPaper) {
      score[block] = enough ? score_of(rule.formula, sums) : undefined();
      return;
    }
    moments[block] = paper_moments(sums);
    if (!enough) moments[block].product = undefined();
  }

  /// The pair below pixel `i`; returns whether the map was seen there.
  NADIR_HOST_DEVICE bool sample(const PixelPose& pose, int i, Pair& pair) const {
    const float x = pixels.x[i];
    const float y = pixels.y[i];
    const float column = pose.column_part + (pose.cosine * x - pose.sine * y);
    const float row = pose.row_part - (pose.sine * x + pose.cosine * y);
    const float left = floorf(column);
    const float top = floorf(row);
    const std::int64_t at =
        static_cast<std::int64_t>(clamped(pose.row + static_cast<int>(top), map.height)) *
            map.width +
        clamped(pose.column + static_cast<int>(left), map.width);
    const std::uint32_t quad = map.words[at];
    const bool on_map = quad != 0;
    pair.map =
        interpolated(on_map || !rule.whole_square ? quad : map.white[at], column - left, row - top);
    pair.local = pixels.value[i];
    const bool takes_part = on_map || rule.whole_square;
    pair.weight = takes_part ? pixels.weight[i] : 0.0F;
    pair.part = rule.whole_square ? 1.0F : on_map ? pixels.seen[i] : 0.0F;
    return on_map;
  }

 private:
  template <Formula Which>
  NADIR_HOST_DEVICE void sum_as(const PixelPose& pose, int thread, Sums<float>& sums) const {
    for (int i = thread; i < pixels.count; i += kThreads) {
      Pair pair;
      if (sample(pose, i, pair)) sums.seen += pixels.seen[i];
      add_pair<Which>(sums, pair, shifts);
    }
  }

  NADIR_HOST_DEVICE static int clamped(int at, int size) {
    return at < 0 ? 0 : at >= size ? size - 1 : at;
  }

  NADIR_HOST_DEVICE static float interpolated(std::uint32_t quad, float across, float down) {
    const auto upper_left = static_cast<float>(quad & 255U);
    const auto upper_right = static_cast<float>((quad >> 8U) & 255U);
    const auto lower_left = static_cast<float>((quad >> 16U) & 255U);
    const auto lower_right = static_cast<float>(quad >> 24U);
    const float upper = upper_left + across * (upper_right - upper_left);
    const float lower = lower_left + across * (lower_right - lower_left);
    return upper + down * (lower - upper);
  }
};

/// The second pass of [5] over the same poses.
struct ScoreDeviations {
  static constexpr int kThreads = ScorePoses::kThreads;
  struct Partial {
    double sum = 0.0;
  };

  ScorePoses poses;

  NADIR_HOST_DEVICE int blocks() const { return poses.count; }
  NADIR_HOST_DEVICE static void merge(Partial& to, const Partial& from) { to.sum += from.sum; }

  NADIR_HOST_DEVICE Partial partial(int block, int thread) const {
    float sum = 0.0F;
    for (int i = thread; i < poses.pixels.count; i += kThreads) {
      Pair pair;
      poses.sample(poses.poses[block], i, pair);
      add_deviation(sum, pair, poses.shifts, poses.moments[block]);
    }
    return {sum};
  }

  NADIR_HOST_DEVICE void finish(int block, const Partial& partial) const {
    poses.score[block] = partial.sum / poses.moments[block].product;
  }
};

}  // namespace nadir::cuda
