// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

namespace nadir {

/// Philox4x32-10 (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011): four
/// random words that are a pure function of a counter and a key.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// Counter-based random numbers: draw `index` of a stream is a pure function of (seed, stream,
/// index), so results do not depend on the order of the draws or on the number of threads.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::uint64_t stream) : seed_(seed), stream_(stream) {}

  /// Two independent numbers, uniform in [0, 1), 53 bits each.
  std::array<double, 2> uniform_pair(std::uint64_t index) const;
  double uniform(std::uint64_t index) const { return uniform_pair(index)[0]; }
  /// Uniform in [low, high).
  double uniform(std::uint64_t index, double low, double high) const {
    return low + (high - low) * uniform(index);
  }
  /// Two independent standard normal numbers (Box and Muller, 1958).
  std::array<double, 2> normal_pair(std::uint64_t index) const;
  double normal(std::uint64_t index) const { return normal_pair(index)[0]; }

 private:
  std::uint64_t seed_;
  std::uint64_t stream_;
};

}  // namespace nadir
