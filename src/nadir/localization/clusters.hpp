// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/localization/options.hpp"
#include "nadir/localization/particle_set.hpp"

namespace nadir {

/// A group of particles that hang together in (x, y, yaw).
struct Cluster {
  double mass = 0.0;  ///< sum of its weights
  Pose2 mean;         ///< weighted; circular in yaw
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// Bins the particles and joins neighbouring bins (8 in the plane, and the headings beside, around
/// the turn) into clusters, by falling mass. With `cluster_estimate` off: one cluster of all.
std::vector<Cluster> find_clusters(const ParticleSet& particles,
                                   const LocalizationOptions& options);

}  // namespace nadir
