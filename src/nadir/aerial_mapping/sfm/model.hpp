// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "nadir/aerial_mapping/sfm/tracks.hpp"
#include "nadir/core/camera.hpp"
#include "nadir/core/rolling_shutter.hpp"

namespace nadir::aerial {

/// Where a photo was taken from.
struct Pose {
  Eigen::Matrix3d camera_from_map = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< of the middle row
  Eigen::Vector3d flown = Eigen::Vector3d::Zero();   ///< in the readout (rolling_shutter.hpp)
  bool known = false;
};

/// A point of the ground with its track.
struct Landmark {
  Track track;
  std::vector<std::uint8_t> used;  ///< a flag an observation: agrees with the point
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  bool valid = false;

  int used_count() const {
    int count = 0;
    for (const std::uint8_t flag : used) count += flag;
    return count;
  }
};

/// Cameras, poses and points, as far as they are known. Photos and cameras are counted as in the
/// photo set, sorted by name.
struct Model {
  std::vector<CameraModel> cameras;
  std::vector<double> readout_s;  ///< of a camera's rolling shutter: first row to last; 0 = global
  std::vector<std::size_t> camera_of;  ///< of a photo
  std::vector<Pose> poses;             ///< of a photo
  std::vector<Landmark> landmarks;

  const CameraModel& camera(std::size_t photo) const { return cameras[camera_of[photo]]; }

  /// Where the photo sees the point; nothing behind the camera.
  std::optional<Eigen::Vector2d> project(std::size_t photo, const Eigen::Vector3d& point) const {
    const Pose& pose = poses[photo];
    return project_row_by_row(camera(photo), pose.camera_from_map, point - pose.centre, pose.flown);
  }

  /// Where the camera was when it read the row.
  Eigen::Vector3d centre_at(std::size_t photo, double v) const {
    return poses[photo].centre + readout_share(camera(photo), v) * poses[photo].flown;
  }

  /// Direction, in the map, in which the photo sees a pixel.
  Eigen::Vector3d direction(std::size_t photo, double u, double v) const {
    return (poses[photo].camera_from_map.transpose() * camera(photo).ray({u, v})).normalized();
  }

  /// Distance, in pixels, of an observation from the projection of a point; infinite behind.
  double error_px(const Observation& seen, const Eigen::Vector3d& point) const;
};

}  // namespace nadir::aerial
