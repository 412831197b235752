// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/core/stamp.hpp"

namespace nadir {

/// A pose of the robot in the frame `In`, at an instant.
template <class In>
struct StampedPose {
  Stamp stamp;
  Transform2<In, frames::Robot> pose;
};

/// Poses of the robot in the frame `In`, with strictly increasing stamps.
template <class In>
using TrajectoryIn = std::vector<StampedPose<In>>;

using Trajectory = TrajectoryIn<frames::Map>;
using Odometry = TrajectoryIn<frames::Odom>;

/// Two stamps this near to one another are the same instant: clocks and formats round.
inline constexpr double kSameInstantS = 0.01;

/// The pose at an instant: the one nearest to it, at most kSameInstantS away; nothing where there
/// is none.
std::optional<Pose2> pose_at(const Trajectory& trajectory, Stamp stamp);

}  // namespace nadir
