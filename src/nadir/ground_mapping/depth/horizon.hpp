// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "nadir/core/camera.hpp"

namespace nadir::ground {

/// Rows that are worked on together, and the step of the first row below the horizon.
inline constexpr int kRowsPerStripe = 16;

/// The first row that looks below the horizon, less a margin of a twentieth of the image in which
/// the matching gets its run-up; the height of the image where no row does. The camera has no
/// distortion.
int first_ground_row(const CameraModel& camera, const Eigen::Matrix3d& odom_from_camera);

}  // namespace nadir::ground
