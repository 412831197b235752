// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/trajectory.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace nadir {

std::optional<Pose2> pose_at(const Trajectory& trajectory, Stamp stamp) {
  const auto seconds_off = [stamp](const StampedPose<frames::Map>& pose) {
    return std::abs(Stamp{pose.stamp.nanoseconds - stamp.nanoseconds}.seconds());
  };
  const auto after =
      std::ranges::lower_bound(trajectory, stamp, {}, &StampedPose<frames::Map>::stamp);
  std::optional<Pose2> nearest;
  double least = kSameInstantS;
  if (after != trajectory.end() && seconds_off(*after) <= least) {
    least = seconds_off(*after);
    nearest = after->pose;
  }
  if (after != trajectory.begin() && seconds_off(*std::prev(after)) <= least) {
    nearest = std::prev(after)->pose;
  }
  return nearest;
}

}  // namespace nadir
