// SPDX-License-Identifier: Apache-2.0
#include "nadir/localization/options.hpp"

namespace nadir {

LocalizationOptions LocalizationOptions::paper() {
  LocalizationOptions options;
  options.start_particles = options.particles;
  options.likelihood = Likelihood::kLinear;
  options.resampling = Resampling::kMultinomial;
  options.resample_below = 1.0;
  options.adaptive = false;
  // "moves according to the odometry information superimposed with the error": the only noise that
  // the paper gives figures for is that of the resampling.
  options.position_noise_per_m = 0.0;
  options.position_noise_floor_m = 0.0;
  options.yaw_noise_deg_per_m = 0.0;
  options.yaw_noise_deg_per_deg = 0.0;
  options.yaw_noise_floor_deg = 0.0;
  options.odometry_scale_sigma = 0.0;
  options.odometry_scale_walk = 0.0;
  options.roughening_m = 0.1;
  options.roughening_deg = 2.0;
  options.map_error_m = 0.0;
  options.map_error_deg = 0.0;
  options.cluster_estimate = false;
  return options;
}

void declare(OptionTable& table, LocalizationOptions& options) {
  const std::string stage = "localization.";
  const std::string measured = "measured on the Aero-Ground run";
  table.integer(stage + "particles", options.particles, {1.0, 1e7}, "Number of particles.",
                "paper, section V");
  table.integer(stage + "start_particles", options.start_particles, {1.0, 1e7},
                "Number of particles until the first resampling, when the cloud is still wide: "
                "10 m x 10 m x 10 degrees hold about 1000 places of the width of a score's peak, "
                "and each must be hit by several. Never fewer than `particles`.",
                measured);
  table.choice<Likelihood>(stage + "likelihood", options.likelihood, kLikelihoodNames,
                           "How a score becomes a weight: exp(temper * score), or the score "
                           "itself, as the paper has it.");
  table.number(stage + "temper", options.temper, {0.0, 1e4},
               "Sharpness of the likelihood: log-likelihood = temper * score.",
               "measured on the Aero-Ground run and simulated places");
  table.number(stage + "height_temper", options.height_temper, {0.0, 1e4},
               "The same for the score of the heights: log-likelihoods of colour and heights add "
               "up.");
  table.number(stage + "min_effective_share", options.min_effective_share, {0.0, 1.0},
               "Least share of effective particles that one frame may leave: the temper is lowered "
               "for the frame where it would leave fewer, so that a wide cloud is not decided by "
               "one look.",
               measured);
  table.choice<Resampling>(stage + "resampling", options.resampling, kResamplingNames,
                           "How particles are drawn; multinomial is the paper's roulette.");
  table.number(stage + "resample_below", options.resample_below, {0.0, 1.0},
               "Resample when the effective sample size falls below this share of the particles; "
               "1 = at every step.");
  table.flag(stage + "adaptive", options.adaptive,
             "Adapt the number of particles to the spread of the cloud (KLD sampling).",
             "Fox, 2003");
  table.integer(stage + "min_particles", options.min_particles, {1.0, 1e7},
                "Fewest particles of the adaptive filter.");
  table.number(stage + "kld_error", options.kld_error, {1e-4, 1.0},
               "Bound of the Kullback-Leibler distance at 99 % confidence.", "Fox, 2003");
  table.number(stage + "kld_bin_m", options.kld_bin_m, {1e-3, 100.0},
               "Bin size of the adaptive filter, metres.");
  table.number(stage + "kld_bin_deg", options.kld_bin_deg, {1e-3, 360.0},
               "Bin size of the adaptive filter, degrees.");
  table.number(stage + "position_noise_per_m", options.position_noise_per_m, {0.0, 10.0},
               "Standard deviation of the motion per metre travelled, along and across, metres.",
               measured);
  table.number(stage + "position_noise_floor_m", options.position_noise_floor_m, {0.0, 10.0},
               "Its floor per frame, metres.", measured);
  table.number(stage + "yaw_noise_deg_per_m", options.yaw_noise_deg_per_m, {0.0, 90.0},
               "Standard deviation of the turn per metre travelled, degrees.", measured);
  table.number(stage + "yaw_noise_deg_per_deg", options.yaw_noise_deg_per_deg, {0.0, 10.0},
               "Standard deviation of the turn per degree turned, degrees.");
  table.number(stage + "yaw_noise_floor_deg", options.yaw_noise_floor_deg, {0.0, 90.0},
               "Its floor per frame, degrees.", measured);
  table.number(stage + "odometry_scale_sigma", options.odometry_scale_sigma, {0.0, 1.0},
               "Standard deviation of the odometry's scale error at the start; every particle "
               "carries a scale of its own, so that a steady bias is learned. 0 = none.",
               measured);
  table.number(stage + "odometry_scale_walk", options.odometry_scale_walk, {0.0, 1.0},
               "Random walk of that scale per root metre travelled.", measured);
  table.number(stage + "roughening_m", options.roughening_m, {0.0, 10.0},
               "Noise added to positions when resampling, metres.", "paper, section IV: 0.1");
  table.number(stage + "roughening_deg", options.roughening_deg, {0.0, 90.0},
               "Noise added to headings when resampling, degrees.", "paper, section IV: 2");
  table.number(stage + "map_error_m", options.map_error_m, {0.0, 100.0},
               "Standard deviation of the two maps' own error, which no filtering averages out: "
               "added to the reported covariance, along each axis, metres.",
               "paper, section III: the global map is within 0.1 m");
  table.number(stage + "map_error_deg", options.map_error_deg, {0.0, 90.0},
               "The same for the heading, degrees.", measured);
  table.flag(stage + "cluster_estimate", options.cluster_estimate,
             "Report the mean of the heaviest cluster; off: the mean of all particles.");
  table.number(stage + "cluster_bin_m", options.cluster_bin_m, {1e-3, 100.0},
               "Particles in neighbouring bins of this size are one cluster, metres.");
  table.number(stage + "cluster_bin_deg", options.cluster_bin_deg, {1e-3, 360.0},
               "The same for headings, degrees.");
}

}  // namespace nadir
