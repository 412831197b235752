// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "nadir/core/camera.hpp"

namespace nadir {

// A rolling shutter reads a photo row by row while the camera flies on: each row has a centre of
// its own, that of the middle row + share * flown, where `flown` is how far the camera flies from
// the first row to the last (metres, in the map). Turns meanwhile are left out: a gimbal holds
// them. Zero = global shutter.

/// Share of the readout at which the row of pixel coordinate v is read: -0.5 = before the first
/// row, 0.5 = after the last. Beyond the photo as at its border.
inline double readout_share(const CameraModel& camera, double v) {
  return std::clamp((v + 0.5) / camera.height, 0.0, 1.0) - 0.5;
}

/// The pixel of a point that lies at `from_centre` (map axes, metres) from the centre of the middle
/// row; nothing where it is not in front of the camera. The row is that of a first projection
/// without the motion: the pixel is right to (motion in pixels)^2 / height, some 0.01 px.
inline std::optional<Eigen::Vector2d> project_row_by_row(const CameraModel& camera,
                                                         const Eigen::Matrix3d& camera_from_map,
                                                         const Eigen::Vector3d& from_centre,
                                                         const Eigen::Vector3d& flown) {
  auto pixel = camera.project(camera_from_map * from_centre);
  if (!pixel || flown.isZero()) return pixel;
  return camera.project(camera_from_map *
                        (from_centre - readout_share(camera, pixel->y()) * flown));
}

}  // namespace nadir
