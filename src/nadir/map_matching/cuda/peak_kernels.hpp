// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstring>

#include "nadir/map_matching/cuda/host_device.hpp"

namespace nadir::cuda {

/// A number that orders places by score, the earlier first where two are equal; 0 is no place.
using PeakKey = std::uint64_t;

/// The bits of a score so that unsigned integers have its order.
NADIR_HOST_DEVICE inline std::uint32_t ordered_bits(float score) {
  std::uint32_t bits = 0;
  memcpy(&bits, &score, sizeof(bits));
  return (bits & 0x80000000U) != 0 ? ~bits : bits | 0x80000000U;
}

inline float score_of_bits(std::uint32_t ordered) {
  const std::uint32_t bits = (ordered & 0x80000000U) != 0 ? ordered & 0x7FFFFFFFU : ~ordered;
  float score = 0.0F;
  memcpy(&score, &bits, sizeof(score));
  return score;
}

NADIR_HOST_DEVICE inline PeakKey peak_key(float score, std::uint32_t place) {
  return (static_cast<PeakKey>(ordered_bits(score)) << 32U) | (0xFFFFFFFFU - place);
}
inline float score_of(PeakKey key) { return score_of_bits(static_cast<std::uint32_t>(key >> 32U)); }
NADIR_HOST_DEVICE inline std::uint32_t place_of(PeakKey key) {
  return 0xFFFFFFFFU - static_cast<std::uint32_t>(key & 0xFFFFFFFFU);
}

/// The key of every local maximum within its surface, 0 elsewhere (find_peaks()).
struct MarkPeaks {
  const float* score = nullptr;
  int count = 0;  ///< surfaces
  int width = 0;
  int height = 0;
  PeakKey* keys = nullptr;

  NADIR_HOST_DEVICE std::int64_t items() const {
    return static_cast<std::int64_t>(count) * width * height;
  }
  NADIR_HOST_DEVICE void run(std::int64_t item) const {
    const auto column = static_cast<int>(item % width);
    const auto row = static_cast<int>(item / width % height);
    keys[item] = is_peak(score + item, column, row)
                     ? peak_key(score[item], static_cast<std::uint32_t>(item))
                     : 0;
  }

 private:
  NADIR_HOST_DEVICE bool is_peak(const float* at, int column, int row) const {
    if (*at != *at) return false;  // undefined
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        const bool outside =
            column + i < 0 || column + i >= width || row + j < 0 || row + j >= height;
        if (outside || (i == 0 && j == 0)) continue;
        const float other = at[static_cast<std::int64_t>(j) * width + i];
        const bool earlier = j < 0 || (j == 0 && i < 0);
        if (other > *at || (earlier && other == *at)) return false;
      }
    }
    return true;
  }
};

}  // namespace nadir::cuda
