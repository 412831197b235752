// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

namespace nadir::cpu {

struct FftSize {
  std::size_t width = 0;
  std::size_t height = 0;
  bool operator==(const FftSize&) const = default;
};

/// The sizes of least measured cost that hold `width` x `height`.
FftSize cheapest_fft_size(std::size_t width, std::size_t height);

/// Relative cost of one transform of that length, per vector; see fft_size.cpp.
double fft_cost(std::size_t length);

}  // namespace nadir::cpu
