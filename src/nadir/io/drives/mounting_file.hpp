// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "nadir/core/frames3.hpp"

namespace nadir {

/// How the sensors are mounted on the robot: mounting.yaml of docs/formats.md, which says what
/// the calibrations of the common layouts do not.
struct Mounting {
  std::optional<Transform3<frames::Robot, frames::Camera>> robot_from_camera;
  std::optional<Transform3<frames::Robot, frames::Lidar>> robot_from_lidar;
};

/// The name that the readers of drives look for.
inline constexpr const char* kMountingFile = "mounting.yaml";

/// Throws Error (input) with file:line for an unknown key, numbers that are missing or not finite,
/// and a quaternion that is not of unit length.
Mounting read_mounting(const std::filesystem::path& file);

/// Writes atomically.
void write_mounting(const std::filesystem::path& file, const Mounting& mounting);

}  // namespace nadir
