// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/cuda/correlation_kernels.hpp"

namespace nadir::cuda {

// Equation [5] in closed form. The greys R of the map are integers, so that between two
// neighbouring levels the numerator sum w |R - mu| |P - Pm| is linear in the window's mean mu: the
// correlations of |R - level| with w |P - Pm| at the levels below and above give it without error.
// Holes and what lies off the map are white: |R - level| = V (|R - level| - |255 - level|) +
// |255 - level|, and only the first term, 0 where nothing was seen, has to be transformed.

/// Grey levels of a map: 0 .. 255.
inline constexpr int kLevels = 256;

/// What [5] needs of a template once its mean is known, in units of kGreyScale.
struct PaperStats {
  double count = 0.0;      ///< pixels that take part
  double norm = 0.0;       ///< sum (P - Pm)^2
  double deviation = 0.0;  ///< sum w |P - Pm|
};

/// One block for each template, after SumTemplates.
struct SumDeviations {
  static constexpr int kThreads = 256;
  using Partial = PaperStats;

  const TurnedPixel* turned = nullptr;
  const TemplateStats* stats = nullptr;
  int count = 0;
  int pixels = 0;  ///< of the box
  PaperStats* sums = nullptr;

  NADIR_HOST_DEVICE int blocks() const { return count; }

  NADIR_HOST_DEVICE Partial partial(int block, int thread) const {
    Partial sum;
    const TurnedPixel* own = turned + static_cast<std::int64_t>(block) * pixels;
    for (int i = thread; i < pixels; i += kThreads) {
      const double deviation = own[i].mask * fabsf(own[i].value - stats[block].mean) / kGreyScale;
      sum.count += own[i].mask;
      sum.norm += deviation * deviation;
      sum.deviation += own[i].weight * deviation;
    }
    return sum;
  }

  NADIR_HOST_DEVICE static void merge(Partial& to, const Partial& from) {
    to.count += from.count;
    to.norm += from.norm;
    to.deviation += from.deviation;
  }

  NADIR_HOST_DEVICE void finish(int block, const Partial& sum) const { sums[block] = sum; }
};

/// Mean and norm of the window at every position, from the four correlations of [5].
struct WindowMoments {
  const float* correlations = nullptr;  ///< product_planes(Formula::kPaper) of each template
  const TemplateStats* stats = nullptr;
  const PaperStats* sums = nullptr;
  int count = 0;
  Rule rule;
  float map_shift = 0.0F;
  PlaneShape shape;
  Box window;              ///< robot positions, relative to the map's rectangle
  float* mean = nullptr;   ///< mu, grey; NaN where the score is undefined
  float* norm = nullptr;   ///< sqrt(sum (R - mu)^2 sum (P - Pm)^2) / kGreyScale^2
  float* score = nullptr;  ///< 0, to which AddLevels adds, or NaN
  float* share = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * window.width * window.height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const GridPlace place = grid_place(item, window.width, window.height);
    const float* own = correlations +
                       std::int64_t{place.which} * product_planes(Formula::kPaper) * shape.reals() +
                       shape.at_position(window, place);
    const double scale = 1.0 / (static_cast<double>(shape.width) * shape.height);
    const PaperStats& local = sums[place.which];
    const double white = (kWhite - map_shift) / kGreyScale;
    const double unseen = local.count - own[0] * scale;  // pixels below which nothing was seen
    const double r = own[shape.reals()] * scale + white * unseen;
    const double rr = own[2 * shape.reals()] * scale + white * white * unseen;
    const double compared = share_of(own[3 * shape.reals()] * scale, stats[place.which].total_seen);
    share[item] = static_cast<float>(compared);

    const double limit = min_variance() * local.count;
    const double map_norm = local.count > 0.0 ? rr - r * r / local.count : 0.0;
    const bool defined =
        is_enough(rule, compared) && local.count > 0.0 && map_norm >= limit && local.norm >= limit;
    const double grey = map_shift + kGreyScale * (r / local.count);
    mean[item] = static_cast<float>(!defined        ? undefined()
                                    : grey < 0.0    ? 0.0
                                    : grey > kWhite ? kWhite
                                                    : grey);
    norm[item] = defined ? static_cast<float>(sqrt(map_norm * local.norm)) : 0.0F;
    score[item] = defined ? 0.0F : static_cast<float>(undefined());
  }
};

/// The level below a mean that is not NaN; the one above it is a level too.
NADIR_HOST_DEVICE inline int level_below(float mean) {
  const auto level = static_cast<int>(mean);
  return level < kLevels - 2 ? level : kLevels - 2;
}

/// Levels, the first and the last one; none where the last is before the first.
struct LevelRange {
  int first = kLevels;
  int last = -1;
};

/// The levels that the means of each template take: kParts blocks, and ranges, for each.
struct FindLevels {
  static constexpr int kThreads = 256;
  static constexpr int kParts = 64;
  using Partial = LevelRange;

  const float* mean = nullptr;
  int count = 0;
  int positions = 0;  ///< of the window
  LevelRange* ranges = nullptr;

  NADIR_HOST_DEVICE int blocks() const { return count * kParts; }

  NADIR_HOST_DEVICE Partial partial(int block, int thread) const {
    LevelRange range;
    const float* own = mean + static_cast<std::int64_t>(block / kParts) * positions;
    for (int i = block % kParts * kThreads + thread; i < positions; i += kParts * kThreads) {
      if (own[i] != own[i]) continue;  // undefined
      const int level = level_below(own[i]);
      merge(range, {level, level + 1});
    }
    return range;
  }

  NADIR_HOST_DEVICE static void merge(Partial& to, const Partial& from) {
    if (from.first < to.first) to.first = from.first;
    if (from.last > to.last) to.last = from.last;
  }

  NADIR_HOST_DEVICE void finish(int block, const Partial& range) const { ranges[block] = range; }
};

/// V (|R - level| - |255 - level|) / 64 over a rectangle of the map, for a group of levels.
struct LevelPlanes {
  const std::uint8_t* map = nullptr;  ///< 0 = hole
  int map_width = 0;
  Box crop;  ///< the rectangle, in pixels of the map
  int first = 0;
  int count = 0;
  PlaneShape shape;
  float* planes = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const { return shape.reals(); }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const std::uint8_t grey = grey_at(map, map_width, crop, shape, item);
    for (int i = 0; i < count; ++i) {
      const auto level = static_cast<float>(first + i);
      const float deviation = fabsf(static_cast<float>(grey) - level) - fabsf(kWhite - level);
      planes[i * shape.reals() + item] = grey == 0 ? 0.0F : deviation / kGreyScale;
    }
  }
};

/// The spectra of a group of levels times the conjugate of that of one template's w |P - Pm|.
struct MultiplyLevels {
  const Complex* levels = nullptr;
  const Complex* deviation = nullptr;
  int count = 0;
  PlaneShape shape;
  Complex* products = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const { return shape.complexes(); }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const Complex local = deviation[item];
    for (int i = 0; i < count; ++i) {
      const std::int64_t at = i * shape.complexes() + item;
      products[at] = times_conjugate(levels[at], local);
    }
  }
};

/// Adds to the score of one template what the levels of a group contribute to its numerator.
struct AddLevels {
  const float* correlations = nullptr;
  const PaperStats* sums = nullptr;  ///< of the template
  int first = 0;
  int count = 0;
  PlaneShape shape;
  Box window;  ///< robot positions, relative to the map's rectangle
  const float* mean = nullptr;
  const float* norm = nullptr;
  float* score = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(window.width) * window.height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    if (mean[item] != mean[item]) return;  // undefined
    const int level = level_below(mean[item]);
    if (level + 1 < first || level >= first + count) return;
    const std::int64_t at =
        shape.at_position(window, grid_place(item, window.width, window.height));
    const double above = mean[item] - static_cast<float>(level);
    const double numerator =
        (1.0 - above) * numerator_at(level, at) + above * numerator_at(level + 1, at);
    score[item] += static_cast<float>(numerator / norm[item]);
  }

 private:
  /// 0 where the level is of another group.
  NADIR_HOST_DEVICE double numerator_at(int level, std::int64_t at) const {
    if (level < first || level >= first + count) return 0.0;
    const double white = fabsf(kWhite - static_cast<float>(level)) / kGreyScale;
    const double scale = 1.0 / (static_cast<double>(shape.width) * shape.height);
    return correlations[(level - first) * shape.reals() + at] * scale + white * sums->deviation;
  }
};

}  // namespace nadir::cuda
