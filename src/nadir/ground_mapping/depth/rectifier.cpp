// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/rectifier.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/ground_mapping/depth/images.hpp"

namespace nadir::ground {
namespace {

cv::Mat intrinsics(const CameraModel& camera) {
  cv::Mat matrix = (cv::Mat_<double>(3, 3) << camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy,
                    0.0, 0.0, 1.0);
  return matrix;
}

cv::Mat distortion(const CameraModel& camera) {
  cv::Mat row = (cv::Mat_<double>(1, 5) << camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  return row;
}

void check_rig(const StereoRig& rig) {
  check_camera(rig.left, "left");
  check_camera(rig.right, "right");
  if (rig.left.width != rig.right.width || rig.left.height != rig.right.height) {
    throw Error(ErrorKind::kInput,
                "the left camera has " + std::to_string(rig.left.width) + " x " +
                    std::to_string(rig.left.height) + " pixels, the right one " +
                    std::to_string(rig.right.width) + " x " + std::to_string(rig.right.height),
                {}, "both images of a pair need one size: check the calibration");
  }
  if (!rig.right_from_left.is_finite() || !rig.robot_from_left.is_finite()) {
    throw Error(ErrorKind::kInput, "the poses of the stereo cameras are not finite", {},
                "check the calibration");
  }
  const double baseline = rig.baseline_m();
  if (baseline < 1e-6) {
    throw Error(ErrorKind::kInput, "the stereo baseline is 0", {},
                "give the calibration of the pair: the left and right projection are the same");
  }
  if (baseline > 20.0) {
    throw Error(ErrorKind::kInput, "the stereo baseline is " + to_text(baseline) + " m", {},
                "give it in metres; it looks like millimetres");
  }
}

void check_side(const Eigen::Vector3d& right_from_left) {
  if (std::abs(right_from_left.x()) < 0.7 * right_from_left.norm()) {
    throw Error(ErrorKind::kInput, "the cameras of the pair stand one above or behind the other",
                {}, "only pairs side by side are matched: check the calibration");
  }
  if (right_from_left.x() > 0.0) {
    throw Error(
        ErrorKind::kInput,
        "the baseline is negative: the right camera stands to the left of the left one, by " +
            to_text(right_from_left.x()) + " m",
        {}, "swap left and right");
  }
}

}  // namespace

Rectifier::Rectifier(const StereoRig& rig, double scale)
    : scale_(scale), undistorts_(!rig.rectified) {
  check_rig(rig);
  check_side(rig.right_from_left.translation);
  if (undistorts_) {
    compute_maps(rig);
  } else {
    geometry_.left = rig.left;
    geometry_.focal_baseline = rig.left.fx * rig.baseline_m();
    geometry_.disparity_offset = rig.right.cx - rig.left.cx;
    geometry_.robot_from_left = rig.robot_from_left;
  }
  geometry_.left = scaled(geometry_.left, scale);
  geometry_.focal_baseline *= scale;
  geometry_.disparity_offset *= scale;
}

void Rectifier::compute_maps(const StereoRig& rig) {
  const Eigen::Matrix3d turn = rig.right_from_left.rotation.toRotationMatrix();
  const Eigen::Vector3d& shift = rig.right_from_left.translation;
  const cv::Mat rotation = (cv::Mat_<double>(3, 3) << turn(0, 0), turn(0, 1), turn(0, 2),
                            turn(1, 0), turn(1, 1), turn(1, 2), turn(2, 0), turn(2, 1), turn(2, 2));
  const cv::Mat translation = (cv::Mat_<double>(3, 1) << shift.x(), shift.y(), shift.z());
  const cv::Size size(rig.left.width, rig.left.height);
  cv::Mat left_turn, right_turn, left_projection, right_projection, disparity_to_depth;
  cv::stereoRectify(intrinsics(rig.left), distortion(rig.left), intrinsics(rig.right),
                    distortion(rig.right), size, rotation, translation, left_turn, right_turn,
                    left_projection, right_projection, disparity_to_depth, cv::CALIB_ZERO_DISPARITY,
                    0.0, size);
  cv::initUndistortRectifyMap(intrinsics(rig.left), distortion(rig.left), left_turn,
                              left_projection, size, CV_16SC2, left_xy_, left_fraction_);
  cv::initUndistortRectifyMap(intrinsics(rig.right), distortion(rig.right), right_turn,
                              right_projection, size, CV_16SC2, right_xy_, right_fraction_);
  geometry_.left = {.width = size.width,
                    .height = size.height,
                    .fx = left_projection.at<double>(0, 0),
                    .fy = left_projection.at<double>(1, 1),
                    .cx = left_projection.at<double>(0, 2),
                    .cy = left_projection.at<double>(1, 2)};
  geometry_.focal_baseline = -right_projection.at<double>(0, 3);
  geometry_.disparity_offset = right_projection.at<double>(0, 2) - left_projection.at<double>(0, 2);
  Eigen::Matrix3d rectified_from_left;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rectified_from_left(i, j) = left_turn.at<double>(i, j);
  }
  geometry_.robot_from_left = rig.robot_from_left;
  geometry_.robot_from_left.rotation =
      (rig.robot_from_left.rotation * Eigen::Quaterniond(rectified_from_left).conjugate())
          .normalized();
}

cv::Mat Rectifier::rectify(const Raster<std::uint8_t>& image, const cv::Mat& map_xy,
                           const cv::Mat& map_fraction, int first_row) const {
  const cv::Mat whole = view_of(image);
  // Rows of the full-size image that the wanted ones are made of.
  const int first = std::min(whole.rows - 1, static_cast<int>(std::lround(first_row / scale_)));
  const cv::Range rows(first, whole.rows);
  cv::Mat part;
  if (undistorts_) {
    cv::remap(whole, part, map_xy.rowRange(rows), map_fraction.rowRange(rows), cv::INTER_LINEAR);
  } else {
    part = whole.rowRange(rows);
  }
  if (scale_ == 1.0) return part;
  cv::Mat small;
  cv::resize(part, small, {geometry_.left.width, geometry_.left.height - first_row}, 0.0, 0.0,
             cv::INTER_AREA);
  return small;
}

cv::Mat Rectifier::left(const Raster<std::uint8_t>& image, int first_row) const {
  return rectify(image, left_xy_, left_fraction_, first_row);
}

cv::Mat Rectifier::right(const Raster<std::uint8_t>& image, int first_row) const {
  return rectify(image, right_xy_, right_fraction_, first_row);
}

}  // namespace nadir::ground
