// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "nadir/core/trajectory.hpp"

namespace nadir {

/// Reads a TUM trajectory, `t tx ty tz qx qy qz qw` a line, `#` comments; its planar part (x, y,
/// yaw of the quaternion). Throws Error (input) with file:line for a missing file, a short line, a
/// value that is not a finite number, a zero quaternion, an x axis that points straight up, or
/// stamps that do not increase. A file with comments alone is an empty trajectory.
Trajectory read_tum(const std::filesystem::path& path);
/// The same as odometry: poses of the robot in the odometry frame.
Odometry read_tum_odometry(const std::filesystem::path& path);

/// Writes TUM lines with nine decimals of time, metres and quaternion, atomically. Throws Error
/// (processing) for a pose that is not finite or stamps that do not increase.
void write_tum(const std::filesystem::path& path, const Trajectory& trajectory);
void write_tum(const std::filesystem::path& path, const Odometry& odometry);

}  // namespace nadir
