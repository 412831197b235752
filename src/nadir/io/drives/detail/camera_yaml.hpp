// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "nadir/core/sensors.hpp"
#include "nadir/io/trajectories/pose_file.hpp"

namespace nadir {

/// EuRoC's sensor.yaml of one camera.
struct EurocCamera {
  CameraModel model;
  Transform3<frames::PoseSensor, frames::Camera> body_from_camera;
};
EurocCamera read_euroc_camera(const std::filesystem::path& file);

/// The rig of a Kalibr camchain: cam0 is the left camera, cam1 has T_cn_cnm1.
StereoRig read_kalibr_rig(const std::filesystem::path& file);

/// The rig of OpenCV's stereo calibration, gathered from one file or several (intrinsics.yml,
/// extrinsics.yml): M1, D1, M2, D2, R, T; with P1, P2 alone the images are taken as rectified.
StereoRig read_opencv_rig(const std::vector<std::filesystem::path>& files);

/// Whether a file is OpenCV's dialect of YAML, which starts with %YAML:1.0.
bool is_opencv_yaml(const std::filesystem::path& file);

// All throw Error (input) with the file, and the line where there is one, for a missing key, a
// model other than a pinhole with radial-tangential distortion, or a matrix that is no rotation.

}  // namespace nadir
