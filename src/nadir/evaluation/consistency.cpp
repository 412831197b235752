// SPDX-License-Identifier: Apache-2.0
#include "nadir/evaluation/consistency.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

constexpr double kDegreesOfFreedom = 3.0;
constexpr double kNormalQuantile975 = 1.959963984540054;
constexpr double kChiSquare3Quantile95 = 7.814727903251179;

double chi_square_quantile(double degrees_of_freedom, double normal_quantile) {
  const double variance = 2.0 / (9.0 * degrees_of_freedom);
  return degrees_of_freedom * std::pow(1.0 - variance + normal_quantile * std::sqrt(variance), 3.0);
}

/// Nothing where the covariance has no inverse.
std::optional<double> normalised_error(const PosePair& pair, const PoseCovariance& covariance) {
  const Eigen::Vector3d error(pair.estimated.x - pair.truth.x, pair.estimated.y - pair.truth.y,
                              wrap_angle(pair.estimated.yaw - pair.truth.yaw));
  const Eigen::LDLT<PoseCovariance> factor(covariance);
  const Eigen::Vector3d pivots = factor.vectorD();
  // Relative to the diagonal, as the parts have different units.
  const double smallest = 1e-12 * covariance.diagonal().cwiseAbs().maxCoeff();
  if (factor.info() != Eigen::Success || !(pivots.minCoeff() > smallest)) return std::nullopt;
  return error.dot(factor.solve(error));
}

const PoseCovariance& covariance_at(const std::vector<StampedCovariance>& covariances,
                                    Stamp stamp) {
  const auto found = std::ranges::lower_bound(covariances, stamp, {}, &StampedCovariance::stamp);
  if (found == covariances.end() || found->stamp != stamp) {
    throw Error(ErrorKind::kInput, "no covariance has the stamp of the estimate",
                "stamp " + to_string(stamp), "use the covariances of the same run");
  }
  return found->covariance;
}

void require_sound(const std::vector<StampedCovariance>& covariances) {
  for (std::size_t i = 0; i < covariances.size(); ++i) {
    const std::string where = "covariance, stamp " + to_string(covariances[i].stamp);
    if (!covariances[i].covariance.allFinite()) {
      throw Error(ErrorKind::kInput, "it is not finite", where);
    }
    if (i > 0 && covariances[i].stamp <= covariances[i - 1].stamp) {
      throw Error(ErrorKind::kInput, "the stamp does not increase", where);
    }
  }
}

}  // namespace

ConsistencyBand consistency_band(int frames) {
  if (frames <= 0) return {};
  const double degrees_of_freedom = kDegreesOfFreedom * frames;
  return {chi_square_quantile(degrees_of_freedom, -kNormalQuantile975) / frames,
          chi_square_quantile(degrees_of_freedom, kNormalQuantile975) / frames};
}

Consistency consistency(const Trajectory& estimated,
                        const std::vector<StampedCovariance>& covariances, const Trajectory& truth,
                        const EvaluationOptions& options) {
  require_sound(covariances);
  const Association association = associate(estimated, truth, options);
  Consistency result;
  double sum = 0.0;
  int within = 0;
  for (const PosePair& pair : association.pairs) {
    const auto nees = normalised_error(pair, covariance_at(covariances, pair.estimated_stamp));
    if (!nees) {
      ++result.singular_frames;
      continue;
    }
    ++result.frames;
    sum += *nees;
    if (*nees <= kChiSquare3Quantile95) ++within;
  }
  if (result.frames == 0) return result;
  result.mean_nees = sum / result.frames;
  result.share_within_95 = static_cast<double>(within) / result.frames;
  result.band = consistency_band(result.frames);
  return result;
}

}  // namespace nadir
