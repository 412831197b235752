// SPDX-License-Identifier: Apache-2.0
#include "nadir/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

/// The best particle of a frame: NaN where none could be compared.
PoseScore best_of(const std::vector<PoseScore>& scores) {
  PoseScore best{std::numeric_limits<double>::quiet_NaN(), 0.0};
  for (const PoseScore& score : scores) {
    if (!(score.score <= best.score) && !std::isnan(score.score)) best = score;
  }
  return best;
}

/// The covariance that the maps themselves contribute.
PoseCovariance map_error(const LocalizationOptions& options) {
  const double position = options.map_error_m * options.map_error_m;
  const double yaw = radians(options.map_error_deg) * radians(options.map_error_deg);
  return Eigen::Vector3d(position, position, yaw).asDiagonal();
}

/// Why the frame said nothing: most of the cloud lies where too little can be compared, or what can
/// be compared has no contrast.
EstimateStatus why_not(const std::vector<PoseScore>& scores, const ParticleSet& particles,
                       double min_valid_weight) {
  double overlapping = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i].valid_weight >= min_valid_weight) overlapping += particles.weights[i];
  }
  return overlapping >= 0.5 ? EstimateStatus::kNoTexture : EstimateStatus::kNoOverlap;
}

void check(const Frame& frame, const std::optional<Frame>& previous) {
  if (frame.odom_from_robot && !frame.odom_from_robot->is_finite()) {
    throw Error(ErrorKind::kInput, "the odometry is not finite",
                "frame at " + to_string(frame.stamp) + " s");
  }
  if (previous && frame.stamp <= previous->stamp) {
    throw Error(
        ErrorKind::kInput,
        "the stamp does not come after the one before, " + to_string(previous->stamp) + " s",
        "frame at " + to_string(frame.stamp) + " s");
  }
}

}  // namespace

std::string to_string(EstimateStatus status) {
  switch (status) {
    case EstimateStatus::kOk:
      return "ok";
    case EstimateStatus::kNoOverlap:
      return "no_overlap";
    case EstimateStatus::kNoTexture:
      return "no_texture";
    case EstimateStatus::kNoOdometry:
      return "no_odometry";
  }
  return {};
}

LocalizerOptions LocalizerOptions::paper() {
  LocalizerOptions options;
  options.matching.score = Score::kWncc;
  options.matching.channel = Channel::kGrey;
  options.localization = LocalizationOptions::paper();
  return options;
}

OptionTable option_table(LocalizerOptions& options) {
  OptionTable table;
  declare(table, options.matching);
  declare(table, options.localization);
  declare(table, options.registration);
  return table;
}

Localizer::Localizer(const Orthomosaic& map, const LocalizerOptions& options, std::uint64_t seed)
    : options_(options), map_(map, options.matching), filter_(options.localization, seed) {
  const Score score = options.matching.score;
  if (options.localization.likelihood == Likelihood::kLinear &&
      (score == Score::kSsd || score == Score::kSad)) {
    throw Error(
        ErrorKind::kUsage,
        "the score " + to_string(score) + " is never positive and cannot be a weight itself", {},
        "set localization.likelihood to tempered or take another score");
  }
}

void Localizer::start_near(const Pose2& prior, const Spread& spread) {
  filter_.start_near(prior, spread);
  previous_.reset();
  weighed_ = false;
}

Estimate Localizer::update(const Frame& frame) {
  if (!filter_.started()) throw Error(ErrorKind::kUsage, "the localizer was not started");
  check(frame, previous_);

  Estimate estimate;
  estimate.stamp = frame.stamp;
  const std::optional<Motion2> motion = motion_since_previous(frame);
  // Drawn anew only now, so that until here particles() showed the weights of the last frame.
  if (previous_) {
    if (weighed_) estimate.resampled = filter_.resample_if_needed();
    filter_.predict(motion.value_or(last_motion_));
  }
  if (motion) last_motion_ = *motion;
  if (!motion) estimate.status = EstimateStatus::kNoOdometry;

  const Template local = make_template(frame.local, options_.matching);
  const std::vector<PoseScore> scores = score_poses(map_, local, filter_.particles().poses);
  std::vector<double> values;
  for (const PoseScore& score : scores) values.push_back(score.score);
  weighed_ = filter_.weigh(values);
  if (!weighed_)
    estimate.status = why_not(scores, filter_.particles(), options_.matching.min_valid_weight);

  const PoseScore best = best_of(scores);
  estimate.best_score = best.score;
  estimate.valid_weight = best.valid_weight;
  estimate.effective_particles = filter_.effective_particles();
  const std::vector<Cluster> clusters = filter_.clusters();
  estimate.map_from_robot = clusters.front().mean;
  estimate.covariance = clusters.front().covariance + map_error(options_.localization);
  estimate.cluster_mass = clusters.front().mass;
  estimate.clusters = static_cast<int>(clusters.size());
  previous_ = frame;
  return estimate;
}

std::optional<Motion2> Localizer::motion_since_previous(const Frame& frame) const {
  if (!previous_) return Motion2{};
  if (frame.odom_from_robot && previous_->odom_from_robot) {
    return previous_->odom_from_robot->inverse() * *frame.odom_from_robot;
  }
  return register_local_maps(previous_->local, frame.local, options_.registration);
}

}  // namespace nadir
