// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/core/random.hpp"
#include "nadir/localization/clusters.hpp"
#include "nadir/localization/options.hpp"
#include "nadir/localization/particle_set.hpp"

namespace nadir {

/// Half the extent of the uniform start: a square of +-position and a range of +-yaw.
struct Spread {
  double position_m = 5.0;
  double yaw_rad = radians(5.0);
};

/// What one way of looking says of every particle: its score, NaN = could not be compared, and how
/// sharp a likelihood that score is.
struct Evidence {
  std::vector<double> scores;
  double temper = 0.0;
};

/// A particle filter over SE(2). Random numbers are a pure function of (seed, step, particle).
class ParticleFilter {
 public:
  ParticleFilter(const LocalizationOptions& options, std::uint64_t seed);

  /// Throws Error (usage) for a prior or a spread that is not finite, or a negative spread.
  void start_near(const Pose2& prior, const Spread& spread);
  bool started() const { return particles_.size() > 0; }

  /// Moves every particle by the odometry increment, scaled by its own estimate of the odometry's
  /// scale, and by the noise of the motion. `motion` must be finite.
  void predict(const Motion2& motion);
  /// Weighs every particle by its score; NaN = the pose could not be compared. Returns false, and
  /// leaves the weights as they were, where no pose could be. Once a frame has counted, poses that
  /// hold half of the weight must be comparable: the few at the rim of the map must not win over
  /// the many beyond it by being the only ones that were asked. The cloud of the start may well
  /// lie beyond the rim for the most part.
  bool weigh(std::span<const double> scores);
  /// The same from several independent ways of looking: their log-likelihoods add up. One that
  /// could compare too few poses is left out; returns false where none is left.
  bool weigh(std::span<const Evidence> evidence);
  /// Resamples where the effective sample size has fallen; returns whether it did.
  bool resample_if_needed();

  double effective_particles() const;
  /// Clusters by falling mass; one, of all particles, where clustering is off.
  std::vector<Cluster> clusters() const { return find_clusters(particles_, options_); }
  const ParticleSet& particles() const { return particles_; }

 private:
  /// What a random number is for: each purpose of each step has a stream of its own.
  enum class Purpose : std::uint64_t {
    kStart,
    kMotion,
    kScale,
    kResample,
    kThin,
    kRoughen,
    kCount
  };
  RandomStream stream(Purpose purpose) const;
  /// The scores, the lowest in place of those that are undefined; nothing where too few are.
  std::optional<std::vector<double>> filled_scores(std::span<const double> scores) const;
  /// Multiplies the weights by exp(temper * log_gain); false where all would vanish.
  bool apply(std::span<const double> log_gain, double temper);
  /// The temper, lowered where it would leave fewer effective particles than allowed.
  double bounded_temper(std::span<const double> log_gain, double temper) const;
  void resample(std::size_t count, Purpose purpose);
  void roughen();

  LocalizationOptions options_;
  std::uint64_t seed_;
  std::uint64_t step_ = 0;
  bool weighed_ = false;  ///< a frame has counted since the start
  ParticleSet particles_;
};

}  // namespace nadir
