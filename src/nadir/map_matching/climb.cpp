// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "nadir/map_matching/peaks.hpp"
#include "nadir/map_matching/surface.hpp"

namespace nadir {
namespace {

constexpr int kClimbs = 6;
constexpr double kFirstStepPx = 0.5;
constexpr double kSmallestStepPx = 0.05;

/// Steps along x, y and yaw that move the template's pixels about equally far.
Eigen::Vector3d unit_steps(const ChannelImage& local) {
  const double radius = 0.25 * (local.value.width() + local.value.height()) * local.geo.resolution;
  return {local.geo.resolution, local.geo.resolution, local.geo.resolution / radius};
}

Pose2 moved(const Pose2& pose, const Eigen::Vector3d& by) {
  return {pose.x + by.x(), pose.y + by.y(), wrap_angle(pose.yaw + by.z())};
}

/// The offsets at which a quadratic in `axes` variables is sampled: the centre, both ways along
/// each axis, and one corner of each pair of axes.
std::vector<Eigen::Vector3d> stencil(int axes) {
  std::vector<Eigen::Vector3d> offsets = {Eigen::Vector3d::Zero()};
  for (int a = 0; a < axes; ++a) {
    offsets.emplace_back(Eigen::Vector3d::Unit(a));
    offsets.emplace_back(-Eigen::Vector3d::Unit(a));
  }
  for (int a = 0; a < axes; ++a) {
    for (int b = a + 1; b < axes; ++b) {
      offsets.emplace_back(Eigen::Vector3d::Unit(a) + Eigen::Vector3d::Unit(b));
      offsets.emplace_back(-Eigen::Vector3d::Unit(a) - Eigen::Vector3d::Unit(b));
    }
  }
  return offsets;
}

/// The maximum of the quadratic through the stencil's scores, in steps, at most one step away along
/// each axis; zero where the quadratic has no maximum.
Eigen::Vector3d vertex(const std::vector<PoseScore>& scores, int axes) {
  const auto at = [&](int i) { return scores[static_cast<std::size_t>(i)].score; };
  Eigen::VectorXd gradient(axes);
  Eigen::MatrixXd hessian(axes, axes);
  for (int a = 0; a < axes; ++a) {
    gradient(a) = 0.5 * (at(1 + 2 * a) - at(2 + 2 * a));
    hessian(a, a) = at(1 + 2 * a) + at(2 + 2 * a) - 2.0 * at(0);
  }
  int corner = 1 + 2 * axes;
  for (int a = 0; a < axes; ++a) {
    for (int b = a + 1; b < axes; ++b, corner += 2) {
      hessian(a, b) = hessian(b, a) =
          0.5 * (at(corner) + at(corner + 1) - 2.0 * at(0) - hessian(a, a) - hessian(b, b));
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> factor(-hessian);
  Eigen::Vector3d step = Eigen::Vector3d::Zero();
  if (!gradient.allFinite() || !hessian.allFinite() || factor.info() != Eigen::Success) return step;
  step.head(axes) = factor.solve(gradient);
  return step.cwiseMax(-1.0).cwiseMin(1.0);
}

}  // namespace

MatchCandidate climb(const MapIndex& map, const Template& local, const MatchCandidate& candidate,
                     bool turn, const StopToken& stop) {
  const int axes = turn ? 3 : 2;
  const std::vector<Eigen::Vector3d> offsets = stencil(axes);
  const Eigen::Vector3d unit = unit_steps(local.channel);
  MatchCandidate best = candidate;
  best.score = -std::numeric_limits<double>::infinity();
  Pose2 centre = candidate.map_from_robot;
  double step_px = kFirstStepPx;
  for (int i = 0; i < kClimbs; ++i) {
    std::vector<Pose2> poses;
    for (const Eigen::Vector3d& offset : offsets) {
      poses.push_back(moved(centre, step_px * offset.cwiseProduct(unit)));
    }
    const std::vector<PoseScore> scores =
        backend_of(map.options()).score_poses(map, local, poses, stop);  // exact

    for (std::size_t k = 0; k < scores.size(); ++k) {
      if (scores[k].score > best.score) {
        best = {poses[k], scores[k].score, scores[k].valid_weight};
      }
    }
    const Eigen::Vector3d step = vertex(scores, axes);
    centre = step.isZero() ? best.map_from_robot : moved(centre, step_px * step.cwiseProduct(unit));
    step_px = std::max(0.5 * step_px, kSmallestStepPx);
  }
  return std::isfinite(best.score) ? best : candidate;
}

}  // namespace nadir
