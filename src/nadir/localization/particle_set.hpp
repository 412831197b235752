// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/core/frames.hpp"

namespace nadir {

/// Weighted hypotheses of where the robot is. The weights sum to 1.
struct ParticleSet {
  std::vector<Pose2> poses;             ///< map_from_robot
  std::vector<double> odometry_scales;  ///< true travel / travel that the odometry says
  std::vector<double> weights;

  std::size_t size() const { return poses.size(); }
};

}  // namespace nadir
