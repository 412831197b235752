// SPDX-License-Identifier: Apache-2.0
#include "nadir/localizer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

constexpr PoseScore kNothing{std::numeric_limits<double>::quiet_NaN(), 0.0};

/// The best particle of a frame: NaN where none could be compared.
PoseScore best_of(const std::vector<PoseScore>& scores) {
  PoseScore best = kNothing;
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

void check(const LocalizerOptions& options, bool has_surface) {
  const Score score = options.matching.score;
  if (options.localization.likelihood == Likelihood::kLinear &&
      (score == Score::kSsd || score == Score::kSad)) {
    throw Error(
        ErrorKind::kUsage,
        "the score " + to_string(score) + " is never positive and cannot be a weight itself", {},
        "set localization.likelihood to tempered or take another score");
  }
  if (options.matching.layers == Layers::kHeight && !has_surface) {
    throw Error(ErrorKind::kUsage, "heights alone are to be compared, but the map has no surface",
                "map_matching.layers", "give a surface or set it to colour");
  }
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
  options.matching.layers = Layers::kColour;
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
    : Localizer(map, std::nullopt, options, seed) {}

Localizer::Localizer(const Orthomosaic& map, const std::optional<ElevationMap>& surface,
                     const LocalizerOptions& options, std::uint64_t seed)
    : options_(options), geo_(map.geo), filter_(options.localization, seed) {
  check(options, surface.has_value());
  const Layers layers = options.matching.layers;
  if (layers != Layers::kHeight) map_.emplace(map, options.matching);
  if (surface && layers != Layers::kColour) surface_.emplace(*surface, options.matching);
}

void Localizer::start_near(const Pose2& prior, const Spread& spread) {
  filter_.start_near(prior, spread);
  previous_.reset();
  weighed_ = false;
}

void Localizer::use_map(const Orthomosaic& map) {
  constexpr double kSame = 1e-9;
  if (map.geo.crs != geo_.crs || std::abs(map.geo.resolution - geo_.resolution) > kSame) {
    throw Error(ErrorKind::kInput,
                "the new version of the map has another reference system or resolution", {},
                "start the localization anew");
  }
  if (!map_) return;
  MapIndex next(map, options_.matching);  // where it throws, the map before is still there
  map_ = std::move(next);
}

Estimate Localizer::update(const Frame& frame, const StopToken& stop) {
  if (!filter_.started()) throw Error(ErrorKind::kUsage, "the localizer was not started");
  check(frame, previous_);

  Estimate estimate;
  estimate.stamp = frame.stamp;
  const std::optional<Motion2> motion = motion_since_previous(frame, stop);
  // A copy, and taken over at the end: a frame that throws on the way has moved no particle.
  ParticleFilter filter = filter_;
  // Drawn anew only now, so that until here particles() showed the weights of the last frame.
  if (previous_) {
    if (weighed_) estimate.resampled = filter.resample_if_needed();
    filter.predict(motion.value_or(last_motion_));
  }
  if (!motion) estimate.status = EstimateStatus::kNoOdometry;

  const std::vector<Look> looks = look(frame, filter.particles().poses, stop);
  const bool weighed = weigh(filter, looks);
  if (!weighed) estimate.status = why_not(looks, filter.particles().weights);

  const PoseScore best = looks.empty() ? kNothing : best_of(looks.front().scores);
  estimate.best_score = best.score;
  estimate.valid_weight = best.valid_weight;
  estimate.effective_particles = filter.effective_particles();
  const std::vector<Cluster> clusters = filter.clusters();
  estimate.map_from_robot = clusters.front().mean;
  estimate.covariance = clusters.front().covariance + map_error(options_.localization);
  estimate.cluster_mass = clusters.front().mass;
  estimate.clusters = static_cast<int>(clusters.size());

  std::optional<Frame> taken(frame);
  // From here on nothing throws.
  static_assert(std::is_nothrow_move_assignable_v<ParticleFilter>);
  static_assert(std::is_nothrow_move_assignable_v<Frame>);
  filter_ = std::move(filter);
  previous_ = std::move(taken);
  weighed_ = weighed;
  if (motion) last_motion_ = *motion;
  return estimate;
}

std::vector<Localizer::Look> Localizer::look(const Frame& frame, const std::vector<Pose2>& poses,
                                             const StopToken& stop) const {
  const LocalizationOptions& options = options_.localization;
  std::vector<Look> looks;
  if (map_) {
    const Template local = make_template(frame.local, options_.matching);
    looks.push_back({score_poses(*map_, local, poses, stop), options.temper});
  }
  if (surface_ && frame.elevation) {
    const Template local = make_template(*frame.elevation, options_.matching);
    looks.push_back({score_poses(*surface_, local, poses, stop), options.height_temper});
  }
  return looks;
}

bool Localizer::weigh(ParticleFilter& filter, const std::vector<Look>& looks) {
  std::vector<Evidence> evidence;
  for (const Look& look : looks) {
    evidence.push_back({{}, look.temper});
    for (const PoseScore& score : look.scores) evidence.back().scores.push_back(score.score);
  }
  return filter.weigh(evidence);
}

EstimateStatus Localizer::why_not(const std::vector<Look>& looks,
                                  const std::vector<double>& weights) const {
  for (const Look& look : looks) {
    double overlapping = 0.0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
      if (look.scores[i].valid_weight >= options_.matching.min_valid_weight) {
        overlapping += weights[i];
      }
    }
    if (overlapping < 0.5) return EstimateStatus::kNoOverlap;
  }
  return EstimateStatus::kNoTexture;
}

std::optional<Motion2> Localizer::motion_since_previous(const Frame& frame,
                                                        const StopToken& stop) const {
  if (!previous_) return Motion2{};
  if (frame.odom_from_robot && previous_->odom_from_robot) {
    return previous_->odom_from_robot->inverse() * *frame.odom_from_robot;
  }
  return register_local_maps(previous_->local, frame.local, options_.registration, stop);
}

}  // namespace nadir
