// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <utility>

#include "nadir/core/options.hpp"

namespace nadir {

enum class Resampling { kSystematic, kStratified, kMultinomial };
inline constexpr std::array<std::pair<Resampling, const char*>, 3> kResamplingNames{
    {{Resampling::kSystematic, "systematic"},
     {Resampling::kStratified, "stratified"},
     {Resampling::kMultinomial, "multinomial"}}};

/// How a score becomes a weight.
enum class Likelihood {
  kTempered,  ///< log-likelihood = temper * score
  kLinear,    ///< weight = score, as the paper has it
};
inline constexpr std::array<std::pair<Likelihood, const char*>, 2> kLikelihoodNames{
    {{Likelihood::kTempered, "tempered"}, {Likelihood::kLinear, "linear"}}};

struct LocalizationOptions {
  int particles = 1000;
  int start_particles = 20000;
  Likelihood likelihood = Likelihood::kTempered;
  double temper = 100.0;
  double height_temper = 20.0;
  double min_effective_share = 0.0;
  Resampling resampling = Resampling::kSystematic;
  double resample_below = 0.5;

  bool adaptive = false;
  int min_particles = 200;
  double kld_error = 0.02;
  double kld_bin_m = 0.25;
  double kld_bin_deg = 2.0;

  double position_noise_per_m = 0.20;
  double position_noise_floor_m = 0.03;
  double yaw_noise_deg_per_m = 0.5;
  double yaw_noise_deg_per_deg = 0.1;
  double yaw_noise_floor_deg = 0.2;

  double odometry_scale_sigma = 0.05;
  double odometry_scale_walk = 0.02;

  double roughening_m = 0.0;
  double roughening_deg = 0.0;

  double map_error_m = 0.1;
  double map_error_deg = 0.4;

  double cluster_bin_m = 0.5;
  double cluster_bin_deg = 5.0;
  bool cluster_estimate = true;

  /// The protocol of the paper, section IV: the score is the weight, roulette at every step,
  /// roughening by 0.1 m and 2 degrees, the weighted mean as the estimate.
  static LocalizationOptions paper();
};

void declare(OptionTable& table, LocalizationOptions& options);

}  // namespace nadir
