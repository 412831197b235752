// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ceres/ceres.h>
#include <ceres/rotation.h>

#include <Eigen/Core>

#include "nadir/aerial_mapping/sfm/adjustment.hpp"
#include "nadir/core/rolling_shutter.hpp"

namespace nadir::aerial {

// Parameter blocks: pose = rotation vector of camera_from_map and centre (6), lens = ln f, k1, k2
// (3), readout of its rolling shutter in seconds (1), point (3). Equation numbers are those of
// docs/aerial-mapping.md.

/// [2] Pixel error of an observation, by the projection [1]. `motion` is where the camera of this
/// row was against the middle row's, metres for each second of readout.
struct ReprojectionTerm {
  double u, v, cx, cy;
  Eigen::Vector3d motion;

  template <class T>
  bool operator()(const T* pose, const T* lens, const T* point, const T* readout,
                  T* residual) const {
    T relative[3];
    for (int k = 0; k < 3; ++k) relative[k] = point[k] - pose[3 + k] - readout[0] * motion[k];
    T p[3];
    ceres::AngleAxisRotatePoint(pose, relative, p);
    if (p[2] < T(1e-6)) return false;
    const T x = p[0] / p[2];
    const T y = p[1] / p[2];
    const T r2 = x * x + y * y;
    const T scale = exp(lens[0]) * (T(1.0) + r2 * (lens[1] + r2 * lens[2]));
    residual[0] = scale * x + T(cx - u);
    residual[1] = scale * y + T(cy - v);
    return true;
  }
  static ceres::CostFunction* create(double u, double v, const CameraModel& camera,
                                     const Eigen::Vector3d& velocity) {
    return new ceres::AutoDiffCostFunction<ReprojectionTerm, 2, 6, 3, 3, 1>(
        new ReprojectionTerm{u, v, camera.cx, camera.cy, readout_share(camera, v) * velocity});
  }
};

/// [3] Camera against its GPS fix, which may be late by an offset and have a common bias.
struct PositionTerm {
  Eigen::Vector3d fix, velocity, sigma;

  template <class T>
  bool operator()(const T* pose, const T* offset, const T* bias, T* residual) const {
    for (int k = 0; k < 3; ++k)
      residual[k] = (pose[3 + k] - offset[0] * velocity[k] - T(fix[k]) - bias[k]) / T(sigma[k]);
    return true;
  }
  static ceres::CostFunction* create(const Eigen::Vector3d& fix, const Eigen::Vector3d& velocity,
                                     const Eigen::Vector3d& sigma) {
    return new ceres::AutoDiffCostFunction<PositionTerm, 3, 6, 1, 3>(
        new PositionTerm{fix, velocity, sigma});
  }
};

/// [5] The vertical as the camera sees it against the gimbal's pitch and roll; its yaw has no part.
struct VerticalTerm {
  Eigen::Vector3d down_in_camera;
  Eigen::Vector3d sigma_rad;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    const T down[3] = {T(0.0), T(0.0), T(-1.0)};
    T seen[3];
    ceres::AngleAxisRotatePoint(pose, down, seen);
    for (int k = 0; k < 3; ++k) residual[k] = (seen[k] - down_in_camera[k]) / T(sigma_rad[k]);
    return true;
  }
  /// A sideward tilt moves the vertical along the rows (x), a forward one along the columns.
  static ceres::CostFunction* create(const Eigen::Vector3d& down, const GimbalSigma& sigma) {
    const Eigen::Vector3d sigma_rad{sigma.sideward_rad, sigma.forward_rad, sigma.forward_rad};
    return new ceres::AutoDiffCostFunction<VerticalTerm, 3, 6>(new VerticalTerm{down, sigma_rad});
  }
};

/// A camera's right-hand direction against that of the gimbal's yaw.
struct HeadingTerm {
  Eigen::Vector3d right_in_camera;
  Eigen::Vector3d right_in_map;
  double sigma_rad;

  template <class T>
  bool operator()(const T* pose, T* residual) const {
    const T right[3] = {T(right_in_map[0]), T(right_in_map[1]), T(right_in_map[2])};
    T seen[3];
    ceres::AngleAxisRotatePoint(pose, right, seen);
    for (int k = 0; k < 3; ++k) residual[k] = (seen[k] - right_in_camera[k]) / T(sigma_rad);
    return true;
  }
  static ceres::CostFunction* create(const Eigen::Vector3d& right_in_camera,
                                     const Eigen::Vector3d& right_in_map, double sigma_rad) {
    return new ceres::AutoDiffCostFunction<HeadingTerm, 3, 6>(
        new HeadingTerm{right_in_camera, right_in_map, sigma_rad});
  }
};

/// [4] Focal length and distortion against their priors.
struct LensTerm {
  double log_focal, focal_sigma, distortion_sigma;

  template <class T>
  bool operator()(const T* lens, T* residual) const {
    residual[0] = (lens[0] - T(log_focal)) / T(focal_sigma);
    residual[1] = lens[1] / T(distortion_sigma);
    residual[2] = lens[2] / T(distortion_sigma);
    return true;
  }
  static ceres::CostFunction* create(double log_focal, double focal_sigma,
                                     double distortion_sigma) {
    return new ceres::AutoDiffCostFunction<LensTerm, 3, 3>(
        new LensTerm{log_focal, focal_sigma, distortion_sigma});
  }
};

/// [6] Camera above a point of the ground against the height above take-off.
struct RelativeAltitudeTerm {
  double altitude, sigma;

  template <class T>
  bool operator()(const T* pose, const T* point, T* residual) const {
    residual[0] = (pose[5] - point[2] - T(altitude)) / T(sigma);
    return true;
  }
  static ceres::CostFunction* create(double altitude, double sigma) {
    return new ceres::AutoDiffCostFunction<RelativeAltitudeTerm, 1, 6, 3>(
        new RelativeAltitudeTerm{altitude, sigma});
  }
};

/// A point's height against the mean ground.
struct GroundTerm {
  double sigma;

  template <class T>
  bool operator()(const T* point, const T* ground, T* residual) const {
    residual[0] = (point[2] - ground[0]) / T(sigma);
    return true;
  }
  static ceres::CostFunction* create(double sigma) {
    return new ceres::AutoDiffCostFunction<GroundTerm, 1, 3, 1>(new GroundTerm{sigma});
  }
};

/// [7] A control point against its surveyed place.
struct ControlTerm {
  Eigen::Vector3d surveyed, sigma;

  template <class T>
  bool operator()(const T* point, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = (point[k] - T(surveyed[k])) / T(sigma[k]);
    return true;
  }
  static ceres::CostFunction* create(const Eigen::Vector3d& surveyed,
                                     const Eigen::Vector3d& sigma) {
    return new ceres::AutoDiffCostFunction<ControlTerm, 3, 3>(new ControlTerm{surveyed, sigma});
  }
};

/// Holds N numbers softly where they are.
template <int N>
struct SoftHold {
  Eigen::Matrix<double, N, 1> value, sigma;
  int first;  // of the block

  template <class T>
  bool operator()(const T* block, T* residual) const {
    for (int k = 0; k < N; ++k) residual[k] = (block[first + k] - T(value[k])) / T(sigma[k]);
    return true;
  }
};

}  // namespace nadir::aerial
