// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/clusters.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace nadir {
namespace {

using Bin = std::array<long, 3>;

/// Disjoint sets of particles (Galler and Fischer, 1964), each named by its first member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t item) {
    while (parent_[item] != item) item = parent_[item] = parent_[parent_[item]];
    return item;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = find(a);
    const std::size_t root_b = find(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Turns the headings into whole bins of a full turn, so that -pi and pi are neighbours.
class Binning {
 public:
  explicit Binning(const LocalizationOptions& options)
      : size_m_(options.cluster_bin_m),
        turn_(std::max(1L, std::lround(360.0 / options.cluster_bin_deg))) {}

  Bin bin_of(const Pose2& pose) const {
    const double share = (pose.yaw + kPi) / (2.0 * kPi);
    return {std::lround(std::floor(pose.x / size_m_)), std::lround(std::floor(pose.y / size_m_)),
            wrapped(std::lround(std::floor(share * static_cast<double>(turn_))))};
  }
  long wrapped(long yaw) const { return (yaw % turn_ + turn_) % turn_; }

 private:
  double size_m_;
  long turn_;
};

Cluster summarise(const ParticleSet& particles, const std::vector<std::size_t>& members) {
  Cluster cluster;
  for (const std::size_t i : members) cluster.mass += particles.weights[i];
  // A cluster whose weights have all vanished still has a middle.
  const auto weight = [&](std::size_t i) {
    return cluster.mass > 0.0 ? particles.weights[i] / cluster.mass
                              : 1.0 / static_cast<double>(members.size());
  };
  double cosine = 0.0;
  double sine = 0.0;
  for (const std::size_t i : members) {
    const Pose2& pose = particles.poses[i];
    cluster.mean.x += weight(i) * pose.x;
    cluster.mean.y += weight(i) * pose.y;
    cosine += weight(i) * std::cos(pose.yaw);
    sine += weight(i) * std::sin(pose.yaw);
  }
  cluster.mean.yaw = std::atan2(sine, cosine);
  for (const std::size_t i : members) {
    const Pose2& pose = particles.poses[i];
    const Eigen::Vector3d deviation(pose.x - cluster.mean.x, pose.y - cluster.mean.y,
                                    wrap_angle(pose.yaw - cluster.mean.yaw));
    cluster.covariance += weight(i) * deviation * deviation.transpose();
  }
  cluster.mass = std::min(cluster.mass, 1.0);  // the sum of all weights may round to above 1
  return cluster;
}

std::vector<Cluster> join_bins(const ParticleSet& particles, const Binning& binning) {
  std::map<Bin, std::size_t> first_of_bin;
  DisjointSets sets(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto [entry, is_new] = first_of_bin.try_emplace(binning.bin_of(particles.poses[i]), i);
    if (!is_new) sets.join(i, entry->second);
  }
  for (const auto& [bin, particle] : first_of_bin) {
    for (long i = -1; i <= 1; ++i) {
      for (long j = -1; j <= 1; ++j) {
        for (long k = -1; k <= 1; ++k) {
          const auto other =
              first_of_bin.find({bin[0] + i, bin[1] + j, binning.wrapped(bin[2] + k)});
          if (other != first_of_bin.end()) sets.join(particle, other->second);
        }
      }
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < particles.size(); ++i) members[sets.find(i)].push_back(i);
  std::vector<Cluster> clusters;
  for (const auto& [name, indices] : members) clusters.push_back(summarise(particles, indices));
  return clusters;
}

}  // namespace

std::vector<Cluster> find_clusters(const ParticleSet& particles,
                                   const LocalizationOptions& options) {
  if (particles.size() == 0) return {};
  if (!options.cluster_estimate) {
    std::vector<std::size_t> all(particles.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return {summarise(particles, all)};
  }
  std::vector<Cluster> clusters = join_bins(particles, Binning(options));
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.mass > b.mass; });
  return clusters;
}

}  // namespace nadir
