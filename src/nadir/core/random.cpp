// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/random.hpp"

#include <cmath>

#include "nadir/core/angle.hpp"

namespace nadir {
namespace {

constexpr int kRounds = 10;
constexpr std::uint32_t kMultiplier0 = 0xD2511F53;
constexpr std::uint32_t kMultiplier1 = 0xCD9E8D57;
constexpr std::uint32_t kWeyl0 = 0x9E3779B9;
constexpr std::uint32_t kWeyl1 = 0xBB67AE85;

constexpr std::uint32_t low_word(std::uint64_t value) { return static_cast<std::uint32_t>(value); }
constexpr std::uint32_t high_word(std::uint64_t value) {
  return static_cast<std::uint32_t>(value >> 32U);
}

double unit_interval(std::uint32_t high, std::uint32_t low) {
  const std::uint64_t bits = (static_cast<std::uint64_t>(high) << 32U) | low;
  return static_cast<double>(bits >> 11U) * 0x1.0p-53;
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t product0 = std::uint64_t{kMultiplier0} * counter[0];
    const std::uint64_t product1 = std::uint64_t{kMultiplier1} * counter[2];
    counter = {high_word(product1) ^ counter[1] ^ key[0], low_word(product1),
               high_word(product0) ^ counter[3] ^ key[1], low_word(product0)};
    key[0] += kWeyl0;
    key[1] += kWeyl1;
  }
  return counter;
}

std::array<double, 2> RandomStream::uniform_pair(std::uint64_t index) const {
  const auto words =
      philox4x32({low_word(index), high_word(index), low_word(stream_), high_word(stream_)},
                 {low_word(seed_), high_word(seed_)});
  return {unit_interval(words[0], words[1]), unit_interval(words[2], words[3])};
}

std::array<double, 2> RandomStream::normal_pair(std::uint64_t index) const {
  const auto [u, v] = uniform_pair(index);
  const double radius = std::sqrt(-2.0 * std::log1p(-u));
  return {radius * std::cos(2.0 * kPi * v), radius * std::sin(2.0 * kPi * v)};
}

}  // namespace nadir
