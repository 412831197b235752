// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/core/trajectory.hpp"
#include "nadir/evaluation/evaluation.hpp"

namespace nadir {

/// The covariance that was reported with the estimate of an instant: (x, y, yaw), m^2, m rad,
/// rad^2, in the map frame.
struct StampedCovariance {
  Stamp stamp;
  PoseCovariance covariance = PoseCovariance::Zero();
};

/// The band that holds the average of n independent chi-square variables with 95 % probability.
struct ConsistencyBand {
  double low = 0.0;
  double high = 0.0;
};

/// Does the reported covariance mean what it says? NEES = e^T P^-1 e of the error e = (x, y, yaw);
/// honest covariances give 3 on average, too small ones more, too large ones less (Bar-Shalom et
/// al., "Estimation with Applications to Tracking and Navigation", section 5.4.2). The band holds
/// for independent frames; those of one drive are correlated, so that its NEES wanders more.
struct Consistency {
  int frames = 0;           ///< with an estimate, a truth and an invertible covariance
  int singular_frames = 0;  ///< left out of the mean: their covariance has no inverse
  double mean_nees = 0.0;   ///< 0 where `frames` is 0
  ConsistencyBand band;
  double share_within_95 = 0.0;  ///< share of single frames under the 95 % quantile, 7.815
  bool inside() const { return frames > 0 && mean_nees >= band.low && mean_nees <= band.high; }
};

/// The 95 % band for the average NEES of `frames` frames with 3 degrees of freedom each. Source:
/// Wilson and Hilferty, "The distribution of chi-square", PNAS 1931; off by less than 0.2 % from
/// 10 frames on.
ConsistencyBand consistency_band(int frames);

/// Never aligned. Throws Error as evaluate() does, and (input) for a covariance that is not finite
/// or belongs to no estimate.
Consistency consistency(const Trajectory& estimated,
                        const std::vector<StampedCovariance>& covariances, const Trajectory& truth,
                        const EvaluationOptions& options);

}  // namespace nadir
