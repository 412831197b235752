// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/fft_size.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace nadir::cpu {
namespace {

/// Cost a point of one pass of a radix over vectors, in units of the fastest transforms (about 1 ns
/// a vector lane). Least-squares fit to the measured times of the 130 smooth lengths between 300
/// and 2100; it predicts them to 4 %. Most of it is memory traffic, so passes count and radices
/// hardly.
constexpr std::pair<std::size_t, double> kPassCost[] = {
    {8, 0.118}, {4, 0.119}, {2, 0.134}, {3, 0.135}, {5, 0.124}, {7, 0.125}, {11, 0.152}};
constexpr double kOnceCost = 0.507;
/// After an odd number of passes the result lies in the wrong buffer and is copied back.
constexpr double kCopyCost = 0.196;

/// Column passes do about 1.5 times the work of row passes, and their number grows with the width.
constexpr double kColumnWork = 1.5;

template <class Cost>
std::size_t cheapest(std::size_t length, const Cost& cost) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  // A power of two is never farther than twice the length.
  for (std::size_t n = std::max<std::size_t>(length, 1); n <= 2 * std::max<std::size_t>(length, 1);
       ++n) {
    if (static_cast<double>(n) * kOnceCost >= least) break;
    if (cost(n) < least) {
      least = cost(n);
      best = n;
    }
  }
  return best;
}

}  // namespace

double fft_cost(std::size_t length) {
  double a_point = kOnceCost;
  std::size_t rest = length;
  int passes = 0;
  // In pocketfft's order: 8, 4, then at most one 2, then the odd ones.
  for (const auto& [radix, cost] : kPassCost) {
    while (rest % radix == 0) {
      rest /= radix;
      a_point += cost;
      ++passes;
    }
  }
  if (rest != 1) return std::numeric_limits<double>::infinity();
  if (passes % 2 == 1) a_point += kCopyCost;
  return a_point * static_cast<double>(length);
}

FftSize cheapest_fft_size(std::size_t width, std::size_t height) {
  return {
      cheapest(width,
               [](std::size_t n) { return fft_cost(n) + kColumnWork * static_cast<double>(n); }),
      cheapest(height, fft_cost)};
}

}  // namespace nadir::cpu
