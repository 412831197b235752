// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/resampling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace nadir {

std::vector<std::size_t> draw_indices(Resampling method, std::span<const double> weights,
                                      std::size_t count, const RandomStream& random) {
  std::vector<double> cumulative(weights.size());
  std::partial_sum(weights.begin(), weights.end(), cumulative.begin());
  const double total = cumulative.back();
  const auto index_at = [&](double position) {
    const auto found = std::upper_bound(cumulative.begin(), cumulative.end(), position * total);
    // Rounding can put the last position on the very end: that is the last particle with weight.
    if (found != cumulative.end()) return static_cast<std::size_t>(found - cumulative.begin());
    const auto last = std::lower_bound(cumulative.begin(), cumulative.end(), total);
    return static_cast<std::size_t>(last - cumulative.begin());
  };
  std::vector<std::size_t> indices(count);
  const auto n = static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    switch (method) {
      case Resampling::kSystematic:
        indices[i] = index_at((static_cast<double>(i) + random.uniform(0)) / n);
        break;
      case Resampling::kStratified:
        indices[i] = index_at((static_cast<double>(i) + random.uniform(i)) / n);
        break;
      case Resampling::kMultinomial:
        indices[i] = index_at(random.uniform(i));
        break;
    }
  }
  return indices;
}

double effective_sample_size(std::span<const double> weights) {
  double squares = 0.0;
  for (const double weight : weights) squares += weight * weight;
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

std::size_t kld_particles(const ParticleSet& particles, const LocalizationOptions& options) {
  std::set<std::array<long, 3>> occupied;
  const double bin_yaw = radians(options.kld_bin_deg);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    if (particles.weights[i] <= 0.0) continue;
    const Pose2& pose = particles.poses[i];
    occupied.insert({std::lround(std::floor(pose.x / options.kld_bin_m)),
                     std::lround(std::floor(pose.y / options.kld_bin_m)),
                     std::lround(std::floor(pose.yaw / bin_yaw))});
  }
  const auto lowest = static_cast<double>(std::min(options.min_particles, options.particles));
  const auto highest = static_cast<double>(options.particles);
  if (occupied.size() < 2) return static_cast<std::size_t>(lowest);
  constexpr double kQuantile99 = 2.326347874;  // of the standard normal distribution
  const double degrees = static_cast<double>(occupied.size()) - 1.0;
  const double a = 2.0 / (9.0 * degrees);  // Wilson-Hilferty
  const double base = 1.0 - a + std::sqrt(a) * kQuantile99;
  const double needed = degrees / (2.0 * options.kld_error) * base * base * base;
  return static_cast<std::size_t>(std::ceil(std::clamp(needed, lowest, highest)));
}

}  // namespace nadir
