// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/sensors.hpp"

namespace nadir {

namespace frames {
struct PoseWorld {};   ///< the fixed frame that a file of poses speaks in
struct PoseSensor {};  ///< what its poses are of: robot, camera or body
}  // namespace frames

/// A pose as a file has it, before anything is known about its frames.
struct FilePose {
  std::optional<Stamp> stamp;  ///< KITTI files have none
  Transform3<frames::PoseWorld, frames::PoseSensor> world_from_sensor;
  std::string where;  ///< file:line
};

enum class PoseFileKind {
  kTum,    ///< `t tx ty tz qx qy qz qw`
  kKitti,  ///< twelve numbers: a 3x4 matrix by rows
  kEuroc,  ///< CSV: ns, position, quaternion w first
};

struct PoseFile {
  PoseFileKind kind = PoseFileKind::kTum;
  std::vector<FilePose> poses;  ///< at least one; stamps increase
};

/// Reads poses of space; the kind is told by the first line that is no comment. Throws Error
/// (input) with file:line for a missing file, a line of another length, a value that is not
/// finite, a rotation that is none (|det R - 1|, |R R^T - I| or the length of the quaternion more
/// than 1e-3, 1e-3, 1e-2 off), stamps that do not increase, and a file without a pose.
PoseFile read_pose_file(const std::filesystem::path& path);

/// Writes TUM lines with nine decimals, atomically. Throws Error (processing) for a pose that is
/// not finite or stamps that do not increase.
void write_tum(const std::filesystem::path& path, const std::vector<StampedOdomPose3>& poses);

/// Writes a KITTI line of twelve numbers a pose, atomically; camera poses in a camera's frame.
void write_kitti_poses(const std::filesystem::path& path,
                       const std::vector<Transform3<frames::PoseWorld, frames::PoseSensor>>& poses);

}  // namespace nadir
