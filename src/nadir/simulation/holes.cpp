// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/holes.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/noise.hpp"

namespace nadir::simulation {
namespace {

constexpr int kDirections = 1440;

/// How much each direction from the robot is shadowed: wide wedges and thin streaks.
std::vector<double> shadowed_directions(const SmoothNoise& noise) {
  std::vector<double> wedges;
  for (int i = 0; i < kDirections; ++i) {
    const double x = std::cos(2.0 * kPi * i / kDirections);
    const double y = std::sin(2.0 * kPi * i / kDirections);
    wedges.push_back(noise.fractal(4.0 * x, 4.0 * y, 0.9, 4, 1) +
                     noise.at(40.0 * x, 40.0 * y, 1.0, 2) - 0.5);
  }
  return wedges;
}

/// How readily each pixel becomes a hole; only the order of the values matters.
std::vector<double> fragility(const SmoothNoise& noise, const RandomStream& speckle, int width,
                              int height) {
  const std::vector<double> wedges = shadowed_directions(noise);
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      // -1 .. 1 over the local map, whatever its size
      const double u = (2.0 * column + 1.0) / width - 1.0;
      const double v = (2.0 * row + 1.0) / height - 1.0;
      const double radius = std::hypot(u, v);
      const double turns = 0.5 + std::atan2(v, u) / (2.0 * kPi);
      const double wedge = wedges[static_cast<std::size_t>(turns * kDirections) % kDirections];
      const double blotch = noise.fractal(u, v, 0.35, 3, 3);
      const double edge = radius + 0.25 * noise.fractal(u, v, 0.5, 3, 4);
      const double grain = speckle.uniform(values.size());
      values.push_back(0.75 * wedge * smooth_step(0.15, 0.9, radius) + 0.5 * blotch +
                       1.3 * smooth_step(0.75, 1.15, edge) + 0.9 * smooth_step(0.86, 1.0, grain) +
                       0.25 * grain);
    }
  }
  return values;
}

}  // namespace

void punch_holes(double share, std::uint64_t seed, int frame, Raster<std::uint8_t>& valid) {
  const auto count =
      static_cast<std::size_t>(std::llround(share * static_cast<double>(valid.values().size())));
  if (count == 0) return;
  const std::uint64_t stream = stream_of(Source::kHoles, frame);
  const std::vector<double> values = fragility(
      SmoothNoise(seed, stream), RandomStream(seed, stream), valid.width(), valid.height());
  std::vector<double> sorted = values;
  const auto last_kept = sorted.end() - static_cast<std::ptrdiff_t>(count);
  std::nth_element(sorted.begin(), last_kept, sorted.end());
  const double limit = *last_kept;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= limit) valid.values()[i] = 0;
  }
}

}  // namespace nadir::simulation
