// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/detail/camera_yaml.hpp"

#include <fmt/format.h>

#include "nadir/io/detail/yaml_file.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

Error key_error(const YAML::Node& node, const path& file, const std::string& problem,
                const std::string& remedy) {
  return {ErrorKind::kInput, problem, place_of(node, file), remedy};
}

std::vector<double> calibration_numbers(const YAML::Node& map, const std::string& key,
                                        std::size_t least, const path& file) {
  const YAML::Node list = map[key];
  if (!list || !list.IsSequence() || list.size() < least) {
    throw key_error(map, file, fmt::format("'{}' must be a list of {} numbers", key, least),
                    "give the calibration as its program wrote it");
  }
  return numbers_in(list, key, file);
}

/// pinhole, radial-tangential: the only model that is read; others have another formula.
void check_models(const YAML::Node& camera, const path& file) {
  const std::string model = text_at(camera, "camera_model", file);
  const std::string distortion = text_at(camera, "distortion_model", file);
  if (model == "pinhole" && (distortion.empty() || distortion == "radtan" ||
                             distortion == "radial-tangential" || distortion == "none")) {
    return;
  }
  throw key_error(camera, file, fmt::format("the camera is '{}' with '{}'", model, distortion),
                  "pinhole with radtan is read: calibrate so, or undistort the images");
}

CameraModel camera_of(const YAML::Node& camera, const std::string& distortion_key,
                      const path& file) {
  check_models(camera, file);
  const std::vector<double> k = calibration_numbers(camera, "intrinsics", 4, file);
  const std::vector<double> size = calibration_numbers(camera, "resolution", 2, file);
  CameraModel model;
  model.width = checked_side(size[0], "the width", place_of(camera, file));
  model.height = checked_side(size[1], "the height", place_of(camera, file));
  model.fx = k[0];
  model.fy = k[1];
  model.cx = k[2];
  model.cy = k[3];
  if (!camera[distortion_key]) return model;
  std::vector<double> d = calibration_numbers(camera, distortion_key, 4, file);
  d.resize(5, 0.0);
  model.k1 = d[0];
  model.k2 = d[1];
  model.p1 = d[2];
  model.p2 = d[3];
  model.k3 = d[4];
  return model;
}

template <class To, class From>
Transform3<To, From> transform_of(const std::vector<double>& m, const std::string& where) {
  Eigen::Matrix3d rotation;
  rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
  return rigid<To, From>(rotation, {m[3], m[7], m[11]}, where);
}

EurocCamera euroc_camera(const YAML::Node& root, const path& file) {
  EurocCamera camera;
  camera.model = camera_of(root, "distortion_coefficients", file);
  if (!root["T_BS"] || !root["T_BS"]["data"]) {
    throw key_error(root, file, "has no T_BS", "give EuRoC's sensor.yaml");
  }
  camera.body_from_camera = transform_of<frames::PoseSensor, frames::Camera>(
      calibration_numbers(root["T_BS"], "data", 16, file), place_of(root["T_BS"], file));
  return camera;
}

StereoRig kalibr_rig(const YAML::Node& root, const path& file) {
  if (!root["cam0"] || !root["cam1"] || !root["cam1"]["T_cn_cnm1"]) {
    throw input_error(file, "has no cam0, cam1 and T_cn_cnm1",
                      "give the camchain of a stereo calibration");
  }
  StereoRig rig;
  rig.left = camera_of(root["cam0"], "distortion_coeffs", file);
  rig.right = camera_of(root["cam1"], "distortion_coeffs", file);
  std::vector<double> matrix;
  const YAML::Node rows = root["cam1"]["T_cn_cnm1"];
  for (const YAML::Node& row : rows) {
    for (const YAML::Node& entry : row) {
      matrix.push_back(number_in_file(entry.Scalar(), "T_cn_cnm1", place_of(rows, file)));
    }
  }
  if (matrix.size() != 16) {
    throw key_error(rows, file, "T_cn_cnm1 is no 4x4 matrix", "give it by rows");
  }
  rig.right_from_left =
      transform_of<frames::RightCamera, frames::Camera>(matrix, place_of(rows, file));
  check_rig(rig, place_of(rows, file));
  return rig;
}

}  // namespace

EurocCamera read_euroc_camera(const path& file) {
  return reading_yaml(file, ErrorKind::kInput,
                      [&](const YAML::Node& root) { return euroc_camera(root, file); });
}

StereoRig read_kalibr_rig(const path& file) {
  return reading_yaml(file, ErrorKind::kInput,
                      [&](const YAML::Node& root) { return kalibr_rig(root, file); });
}

}  // namespace nadir
