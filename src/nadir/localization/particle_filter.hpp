// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/localization/options.hpp"

namespace nadir {

/// Half the extent of the uniform start: a square of +-position and a range of +-yaw.
struct Spread {
  double position_m = 5.0;
  double yaw_rad = radians(5.0);
};

/// Weighted hypotheses of where the robot is. The weights sum to 1.
struct ParticleSet {
  std::vector<Pose2> poses;  ///< map_from_robot
  std::vector<double> weights;
};

/// A group of particles that hang together in (x, y, yaw).
struct Cluster {
  double mass = 0.0;  ///< sum of its weights
  Pose2 mean;         ///< weighted; circular in yaw
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// A particle filter over SE(2). Random numbers are a pure function of (seed, step, particle).
class ParticleFilter {
 public:
  ParticleFilter(const LocalizationOptions& options, std::uint64_t seed);

  void start_near(const Pose2& prior, const Spread& spread);
  bool started() const { return !particles_.poses.empty(); }

  /// Moves every particle by the odometry increment and its noise.
  void predict(const Motion2& motion);
  /// Weighs every particle by its score; NaN = the pose could not be compared. Returns false, and
  /// leaves the weights as they were, where no score is defined.
  bool weigh(std::span<const double> scores);
  /// Resamples where the effective sample size has fallen; returns whether it did.
  bool resample_if_needed();

  double effective_particles() const;
  /// Clusters by falling mass; one, of all particles, where clustering is off.
  std::vector<Cluster> clusters() const;
  const ParticleSet& particles() const { return particles_; }

 private:
  LocalizationOptions options_;
  std::uint64_t seed_;
  std::uint64_t step_ = 0;
  ParticleSet particles_;
};

}  // namespace nadir
