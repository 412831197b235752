// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/particle_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "nadir/core/error.hpp"
#include "nadir/localization/resampling.hpp"

namespace nadir {
namespace {

constexpr int kTemperBisections = 20;
/// Weight of the particles that must have been compared for a frame to count, once one has.
constexpr double kMinComparedWeight = 0.5;

/// weights * exp(temper * log_gain), normalised; nothing where all have vanished.
std::optional<std::vector<double>> reweighed(std::span<const double> weights,
                                             std::span<const double> log_gain, double temper) {
  std::vector<double> result(weights.size());
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = std::log(weights[i]) + temper * log_gain[i];
  }
  const double largest = *std::max_element(result.begin(), result.end());
  if (!std::isfinite(largest)) return std::nullopt;
  double sum = 0.0;
  for (double& weight : result) {
    weight = std::exp(weight - largest);
    sum += weight;
  }
  for (double& weight : result) weight /= sum;
  return result;
}

/// The lowest defined score, and the weight of the particles that have one.
struct Defined {
  double lowest = std::numeric_limits<double>::infinity();
  double weight = 0.0;
};
Defined defined_scores(std::span<const double> scores, std::span<const double> weights) {
  Defined defined;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (std::isnan(scores[i])) continue;
    defined.lowest = std::min(defined.lowest, scores[i]);
    defined.weight += weights[i];
  }
  return defined;
}

}  // namespace

ParticleFilter::ParticleFilter(const LocalizationOptions& options, std::uint64_t seed)
    : options_(options), seed_(seed) {}

RandomStream ParticleFilter::stream(Purpose purpose) const {
  return {seed_, step_ * static_cast<std::uint64_t>(Purpose::kCount) +
                     static_cast<std::uint64_t>(purpose)};
}

void ParticleFilter::start_near(const Pose2& prior, const Spread& spread) {
  if (!prior.is_finite() || !std::isfinite(spread.position_m) || !std::isfinite(spread.yaw_rad) ||
      spread.position_m < 0.0 || spread.yaw_rad < 0.0) {
    throw Error(ErrorKind::kUsage,
                "the prior needs a finite x, y and yaw and a spread that is not negative");
  }
  step_ = 0;
  weighed_ = false;
  const auto count =
      static_cast<std::size_t>(std::max(options_.particles, options_.start_particles));
  particles_.poses.resize(count);
  particles_.odometry_scales.resize(count);
  particles_.weights.assign(count, 1.0 / static_cast<double>(count));
  const RandomStream random = stream(Purpose::kStart);
  const RandomStream scale = stream(Purpose::kScale);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [x, y] = random.uniform_pair(2 * i);
    const double yaw = random.uniform(2 * i + 1);
    particles_.poses[i] = {prior.x + spread.position_m * (2.0 * x - 1.0),
                           prior.y + spread.position_m * (2.0 * y - 1.0),
                           wrap_angle(prior.yaw + spread.yaw_rad * (2.0 * yaw - 1.0))};
    particles_.odometry_scales[i] = 1.0 + options_.odometry_scale_sigma * scale.normal(i);
  }
}

void ParticleFilter::predict(const Motion2& motion) {
  ++step_;
  const double travel = std::hypot(motion.x, motion.y);
  const double position_sigma =
      std::hypot(options_.position_noise_per_m * travel, options_.position_noise_floor_m);
  const double yaw_sigma =
      radians(std::hypot(options_.yaw_noise_deg_per_m * travel,
                         options_.yaw_noise_deg_per_deg * degrees(std::abs(motion.yaw)),
                         options_.yaw_noise_floor_deg));
  const double scale_sigma = options_.odometry_scale_walk * std::sqrt(travel);
  const RandomStream noise = stream(Purpose::kMotion);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto [along, across] = noise.normal_pair(2 * i);
    const auto [turn, scale] = noise.normal_pair(2 * i + 1);
    particles_.odometry_scales[i] += scale_sigma * scale;
    const double s = particles_.odometry_scales[i];
    particles_.poses[i] = particles_.poses[i] * Motion2{s * motion.x + position_sigma * along,
                                                        s * motion.y + position_sigma * across,
                                                        motion.yaw + yaw_sigma * turn};
  }
}

std::optional<std::vector<double>> ParticleFilter::filled_scores(
    std::span<const double> scores) const {
  const auto [lowest, weight] = defined_scores(scores, particles_.weights);
  if (weight <= 0.0 || (weighed_ && weight < kMinComparedWeight)) return std::nullopt;
  // A pose that could not be compared is no better than the worst that could.
  std::vector<double> filled(scores.begin(), scores.end());
  std::replace_if(
      filled.begin(), filled.end(), [](double s) { return std::isnan(s); }, lowest);
  return filled;
}

bool ParticleFilter::apply(std::span<const double> log_gain, double temper) {
  const bool linear = options_.likelihood == Likelihood::kLinear;
  auto weights =
      reweighed(particles_.weights, log_gain, linear ? temper : bounded_temper(log_gain, temper));
  if (!weights) return false;
  particles_.weights = std::move(*weights);
  weighed_ = true;
  return true;
}

bool ParticleFilter::weigh(std::span<const double> scores) {
  const Evidence evidence{{scores.begin(), scores.end()}, options_.temper};
  return weigh(std::span(&evidence, 1));
}

bool ParticleFilter::weigh(std::span<const Evidence> evidence) {
  const bool linear = options_.likelihood == Likelihood::kLinear;
  const bool alone = evidence.size() == 1;
  std::vector<double> log_gain(particles_.size(), 0.0);
  bool any = false;
  for (const auto& [scores, temper] : evidence) {
    const std::optional<std::vector<double>> filled = filled_scores(scores);
    if (!filled) continue;
    any = true;
    for (std::size_t i = 0; i < log_gain.size(); ++i) {
      const double score = (*filled)[i];
      log_gain[i] += linear ? std::log(std::max(score, 0.0)) : (alone ? 1.0 : temper) * score;
    }
  }
  return any && apply(log_gain, alone && !linear ? evidence.front().temper : 1.0);
}

double ParticleFilter::bounded_temper(std::span<const double> log_gain, double temper) const {
  const double smallest = options_.min_effective_share * static_cast<double>(particles_.size());
  const auto effective = [&](double tried) {
    const auto weights = reweighed(particles_.weights, log_gain, tried);
    return weights ? effective_sample_size(*weights) : 0.0;
  };
  if (effective(temper) >= smallest) return temper;
  double low = 0.0;
  double high = temper;
  for (int i = 0; i < kTemperBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (effective(middle) >= smallest ? low : high) = middle;
  }
  return low;
}

bool ParticleFilter::resample_if_needed() {
  const auto count = static_cast<double>(particles_.size());
  const bool crowded = particles_.size() > static_cast<std::size_t>(options_.particles);
  const bool always = crowded || options_.resample_below >= 1.0;
  if (!always && effective_particles() >= options_.resample_below * count) return false;
  resample(static_cast<std::size_t>(options_.particles), Purpose::kResample);
  if (options_.adaptive) {
    const std::size_t enough = kld_particles(particles_, options_);
    if (enough < particles_.size()) resample(enough, Purpose::kThin);
  }
  roughen();
  return true;
}

void ParticleFilter::resample(std::size_t count, Purpose purpose) {
  const std::vector<std::size_t> indices =
      draw_indices(options_.resampling, particles_.weights, count, stream(purpose));
  ParticleSet drawn;
  for (const std::size_t index : indices) {
    drawn.poses.push_back(particles_.poses[index]);
    drawn.odometry_scales.push_back(particles_.odometry_scales[index]);
  }
  drawn.weights.assign(count, 1.0 / static_cast<double>(count));
  particles_ = std::move(drawn);
}

void ParticleFilter::roughen() {
  if (options_.roughening_m <= 0.0 && options_.roughening_deg <= 0.0) return;
  const RandomStream noise = stream(Purpose::kRoughen);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Pose2& pose = particles_.poses[i];
    const auto [x, y] = noise.normal_pair(2 * i);
    pose.x += options_.roughening_m * x;
    pose.y += options_.roughening_m * y;
    pose.yaw = wrap_angle(pose.yaw + radians(options_.roughening_deg) * noise.normal(2 * i + 1));
  }
}

double ParticleFilter::effective_particles() const {
  return effective_sample_size(particles_.weights);
}

}  // namespace nadir
