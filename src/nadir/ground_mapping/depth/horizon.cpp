// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/horizon.hpp"

#include <algorithm>

namespace nadir::ground {

int first_ground_row(const CameraModel& camera, const Eigen::Matrix3d& odom_from_camera) {
  // Up in the camera's axes; a ray r looks below the horizon where up . r < 0.
  const Eigen::Vector3d up = odom_from_camera.row(2).transpose();
  const auto below = [&](double column, double row) {
    return up.x() * (column - camera.cx) / camera.fx + up.y() * (row - camera.cy) / camera.fy +
               up.z() <
           0.0;
  };
  int first = camera.height;
  for (const double column : {0.0, camera.width - 1.0}) {
    for (int row = 0; row < first; ++row) {
      if (below(column, row)) first = row;
    }
  }
  if (first == camera.height) return first;
  // A coarse step lets the matching keep its buffers from frame to frame.
  const int margin = camera.height / 20;
  return std::max(0, first - margin) / kRowsPerStripe * kRowsPerStripe;
}

}  // namespace nadir::ground
