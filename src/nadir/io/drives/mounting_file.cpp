// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/mounting_file.hpp"

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

#include "nadir/core/angle.hpp"
#include "nadir/core/options.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/yaml_file.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

const std::array<std::string, 5> kMountingKeys{"version", "robot_from_camera", "robot_from_lidar",
                                               "camera_height_m", "camera_pitch_deg"};
const std::array<std::string, 2> kTransformKeys{"translation_m", "rotation_xyzw"};

Error key_error(const YAML::Node& node, const path& file, const std::string& problem) {
  return {ErrorKind::kInput, problem, place_of(node, file), "see docs/formats.md"};
}

std::vector<double> numbers_at(const YAML::Node& map, const std::string& key, std::size_t count,
                               const path& file) {
  const YAML::Node list = map[key];
  if (!list || !list.IsSequence() || list.size() != count) {
    throw key_error(map, file, fmt::format("'{}' must be a list of {} numbers", key, count));
  }
  return numbers_in(list, key, file);
}

template <class Sensor>
Transform3<frames::Robot, Sensor> transform_at(const YAML::Node& map, const path& file) {
  check_keys(map, kTransformKeys, file);
  const std::vector<double> t = numbers_at(map, "translation_m", 3, file);
  const std::vector<double> q = numbers_at(map, "rotation_xyzw", 4, file);
  const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
  if (std::abs(rotation.norm() - 1.0) > 1e-2) {
    throw key_error(map, file,
                    fmt::format("'rotation_xyzw' has the length {:.6g}, not 1", rotation.norm()));
  }
  return {rotation.normalized(), {t[0], t[1], t[2]}};
}

/// A camera above the robot's origin that looks ahead, `pitch` downwards.
Transform3<frames::Robot, frames::Camera> forward_camera(double height_m, double pitch_rad) {
  const Eigen::Quaterniond down(Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()));
  return {(down * forward_camera_rotation()).normalized(), {0.0, 0.0, height_m}};
}

double number_at(const YAML::Node& root, const std::string& key, const path& file) {
  const std::string text = text_at(root, key, file);
  return text.empty() ? 0.0 : number_in_file(text, key, place_of(root[key], file));
}

Mounting mounting_of(const YAML::Node& root, const path& file) {
  check_keys(root, kMountingKeys, file);
  Mounting mounting;
  if (root["robot_from_lidar"]) {
    mounting.robot_from_lidar = transform_at<frames::Lidar>(root["robot_from_lidar"], file);
  }
  const bool simple = root["camera_height_m"] || root["camera_pitch_deg"];
  if (root["robot_from_camera"]) {
    if (simple) {
      throw key_error(root, file, "gives robot_from_camera and camera_height_m or _pitch_deg");
    }
    mounting.robot_from_camera = transform_at<frames::Camera>(root["robot_from_camera"], file);
  } else if (simple) {
    mounting.robot_from_camera = forward_camera(number_at(root, "camera_height_m", file),
                                                radians(number_at(root, "camera_pitch_deg", file)));
  }
  return mounting;
}

template <class Sensor>
void emit(YAML::Emitter& out, const char* key, const Transform3<frames::Robot, Sensor>& pose) {
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  out << YAML::Key << key << YAML::Value << YAML::BeginMap;
  out << YAML::Key << "translation_m" << YAML::Value << YAML::Flow << YAML::BeginSeq;
  for (const double value : {t.x(), t.y(), t.z()}) out << to_text(value);
  out << YAML::EndSeq << YAML::Key << "rotation_xyzw" << YAML::Value << YAML::Flow
      << YAML::BeginSeq;
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) out << to_text(value);
  out << YAML::EndSeq << YAML::EndMap;
}

}  // namespace

Mounting read_mounting(const path& file) {
  return reading_yaml(file, ErrorKind::kInput,
                      [&](const YAML::Node& root) { return mounting_of(root, file); });
}

void write_mounting(const path& file, const Mounting& mounting) {
  YAML::Emitter out;
  out << YAML::Comment("how the sensors are mounted on the robot; see docs/formats.md of nadir");
  out << YAML::BeginMap << YAML::Key << "version" << YAML::Value << 1;
  if (mounting.robot_from_camera) emit(out, "robot_from_camera", *mounting.robot_from_camera);
  if (mounting.robot_from_lidar) emit(out, "robot_from_lidar", *mounting.robot_from_lidar);
  out << YAML::EndMap;
  write_file(file, std::string(out.c_str()) + "\n");
}

}  // namespace nadir
