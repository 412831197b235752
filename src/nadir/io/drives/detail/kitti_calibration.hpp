// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/sensors.hpp"

namespace nadir {

/// The numbers of a KITTI calibration by their keys ("P0", "Tr", "R_rect_00"); rows of a file
/// without keys are "P0", "P1", … in turn.
class KittiCalibration {
 public:
  /// Throws Error (input) with file:line.
  explicit KittiCalibration(std::filesystem::path file);

  const std::filesystem::path& file() const { return file_; }
  /// The first of the keys that is there, with its place; "" where none is.
  std::string first_of(const std::vector<std::string>& keys) const;
  std::string where(const std::string& key) const { return rows_.at(key).where; }
  bool has(const std::string& key) const { return rows_.contains(key); }
  int projections() const;  ///< rows "P0", "P1", …

  /// Throw Error (input) that names the key, where it is missing or has another number of values.
  Eigen::Matrix<double, 3, 4> matrix34(const std::string& key) const;
  Eigen::Matrix3d matrix33(const std::string& key) const;
  Eigen::Vector3d vector3(const std::string& key) const;

 private:
  struct Row {
    std::string where;
    std::vector<double> values;
  };
  const std::vector<double>& values(const std::string& key, std::size_t count) const;

  std::filesystem::path file_;
  std::map<std::string, Row> rows_;
};

/// The intrinsics of a projection, and where its camera stands: P = K [I | t] projects points of
/// camera 0, so the camera's origin is at -t there.
struct ProjectedCamera {
  CameraModel model;
  Eigen::Vector3d camera_from_camera0 = Eigen::Vector3d::Zero();  ///< t
};
/// Throws Error (input) where the focal length is not above 0.
ProjectedCamera projected_camera(const KittiCalibration& calibration, const std::string& key);

/// The rig of two projections. Throws Error (input) for a missing or negative baseline.
StereoRig kitti_stereo_rig(const KittiCalibration& calibration, const std::string& left,
                           const std::string& right,
                           const Transform3<frames::Robot, frames::Camera>& robot_from_camera0);

/// A rotation and translation as they stand in a file; throws Error (input) where the matrix is no
/// rotation.
template <class To, class From>
Transform3<To, From> rigid(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                           const std::string& where);

void check_rotation(const Eigen::Matrix3d& rotation, const std::string& where);

template <class To, class From>
Transform3<To, From> rigid(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation,
                           const std::string& where) {
  check_rotation(rotation, where);
  return {Eigen::Quaterniond(rotation).normalized(), translation};
}

}  // namespace nadir
