// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/photos/photo_poses.hpp"

namespace nadir::fuzz {

/// Poses of photos, read and carried into a map frame: finite, of cameras that have a size.
inline void require_photo_poses(const std::filesystem::path& path) {
  const ImportedPoses imported = read_photo_poses(path);
  require(!imported.poses.empty(), "a list without poses");
  for (const PhotoPose& pose : imported.poses) {
    require_pose(pose.map_from_camera);
    require(pose.camera.width >= 0 && pose.camera.height >= 0, "a size below 0");
  }
  if (imported.frame == PhotoPoseFrame::kModel) return;
  static const MetricFrame frame = MetricFrame::around({{48.0, 9.0}});
  for (const PhotoPose& pose : in_map_frame(imported, frame)) require_pose(pose.map_from_camera);
}

}  // namespace nadir::fuzz
