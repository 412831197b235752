// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/detail/kitti_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

/// calib_cam_to_cam.txt has a line with a date.
bool is_text_row(std::string_view key) { return key == "calib_time" || key == "corner_dist"; }

}  // namespace

KittiCalibration::KittiCalibration(std::filesystem::path file) : file_(std::move(file)) {
  int unnamed = 0;
  for_each_line(file_, read_file(file_), [&](const std::string& where, const auto& words) {
    std::string key;
    std::size_t first = 0;
    if (words[0].ends_with(':')) {
      key = words[0].substr(0, words[0].size() - 1);
      first = 1;
    } else {
      key = fmt::format("P{}", unnamed++);
    }
    if (is_text_row(key)) return;
    Row row{where, {}};
    for (std::size_t i = first; i < words.size(); ++i) {
      row.values.push_back(number_in_file(words[i], key, where));
    }
    rows_[key] = std::move(row);
  });
  if (rows_.empty()) throw input_error(file_, "holds no calibration", "give KITTI's calib.txt");
}

std::string KittiCalibration::first_of(const std::vector<std::string>& keys) const {
  const auto found = std::ranges::find_if(keys, [&](const std::string& key) { return has(key); });
  return found == keys.end() ? std::string{} : *found;
}

int KittiCalibration::projections() const {
  int count = 0;
  while (has(fmt::format("P{}", count))) ++count;
  return count;
}

const std::vector<double>& KittiCalibration::values(const std::string& key,
                                                    std::size_t count) const {
  const auto row = rows_.find(key);
  if (row == rows_.end()) {
    throw input_error(file_, "has no row '" + key + "'", "give the calibration of this drive");
  }
  if (row->second.values.size() != count) {
    throw Error(
        ErrorKind::kInput,
        fmt::format("'{}' has {} numbers instead of {}", key, row->second.values.size(), count),
        row->second.where, "give matrices by rows");
  }
  return row->second.values;
}

Eigen::Matrix<double, 3, 4> KittiCalibration::matrix34(const std::string& key) const {
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values(key, 12).data());
}

Eigen::Matrix3d KittiCalibration::matrix33(const std::string& key) const {
  using Rows = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  return Eigen::Map<const Rows>(values(key, 9).data());
}

Eigen::Vector3d KittiCalibration::vector3(const std::string& key) const {
  return Eigen::Map<const Eigen::Vector3d>(values(key, 3).data());
}

void check_rotation(const Eigen::Matrix3d& rotation, const std::string& where) {
  constexpr double kAllowed = 1e-3;
  const double skew =
      (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (std::abs(rotation.determinant() - 1.0) <= kAllowed && skew <= kAllowed) return;
  throw Error(ErrorKind::kInput,
              fmt::format("the matrix is no rotation: det {:.6g}, |R R^T - I| {:.3g}",
                          rotation.determinant(), skew),
              where, "correct the calibration");
}

ProjectedCamera projected_camera(const KittiCalibration& calibration, const std::string& key) {
  const Eigen::Matrix<double, 3, 4> p = calibration.matrix34(key);
  const Eigen::Matrix3d k = p.leftCols<3>();
  ProjectedCamera camera;
  camera.model.fx = k(0, 0);
  camera.model.fy = k(1, 1);
  camera.model.cx = k(0, 2);
  camera.model.cy = k(1, 2);
  if (!(k(0, 0) > 0.0) || !(k(1, 1) > 0.0)) {
    throw Error(
        ErrorKind::kInput,
        fmt::format("'{}' has the focal length {:.6g} x {:.6g} pixels", key, k(0, 0), k(1, 1)),
        calibration.where(key), "a row is fx 0 cx tx 0 fy cy ty 0 0 1 tz");
  }
  camera.camera_from_camera0 = k.inverse() * p.col(3);
  if (!camera.camera_from_camera0.allFinite()) {
    throw Error(ErrorKind::kInput,
                fmt::format("'{}' is no projection: its matrix is singular", key),
                calibration.where(key), "a row is fx 0 cx tx 0 fy cy ty 0 0 1 tz");
  }
  return camera;
}

StereoRig kitti_stereo_rig(const KittiCalibration& calibration, const std::string& left,
                           const std::string& right,
                           const Transform3<frames::Robot, frames::Camera>& robot_from_camera0) {
  const ProjectedCamera left_camera = projected_camera(calibration, left);
  const ProjectedCamera right_camera = projected_camera(calibration, right);
  StereoRig rig;
  rig.left = left_camera.model;
  rig.right = right_camera.model;
  rig.right_from_left.translation =
      right_camera.camera_from_camera0 - left_camera.camera_from_camera0;
  rig.robot_from_left = robot_from_camera0;
  rig.robot_from_left.translation -= robot_from_camera0.rotation * left_camera.camera_from_camera0;
  rig.rectified = rig.left == rig.right;
  check_rig(rig, calibration.where(right) + ", row '" + right + "'");
  if (rig.rectified) rig.right_from_left.translation = {-rig.baseline_m(), 0.0, 0.0};
  return rig;
}

}  // namespace nadir
