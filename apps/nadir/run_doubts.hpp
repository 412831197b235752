// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "seed_run.hpp"

namespace nadir::cli {

/// What the doubts of a run come from.
struct RunSummary {
  std::size_t frames = 0;
  std::size_t compared = 0;  ///< with the map
  PoseCovariance last_covariance = PoseCovariance::Zero();
  double last_cluster_mass = 1.0;  ///< share of the weight at the estimate
  int last_clusters = 1;
  const Judgement* judgement = nullptr;  ///< none without a truth
};

/// Why the poses of a run must not be relied on unseen; nothing where they may.
std::vector<std::string> doubts_of(const RunSummary& run);
std::vector<std::string> doubts_of(const SeedRun& run);

/// Two standard deviations of the position along its most uncertain direction, metres.
double two_sigma_m(const PoseCovariance& covariance);

}  // namespace nadir::cli
