// SPDX-License-Identifier: Apache-2.0
#include <cpl_minixml.h>

#include <map>
#include <memory>
#include <sstream>

#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/detail/pose_formats.hpp"

// Metashape's cameras.xml: sensors with their calibration, cameras with a 4 x 4 transform to the
// chunk, and the chunk's transform to geocentric coordinates. Principal point from the centre of
// the image; p1 and p2 the other way round than OpenCV's.
namespace nadir {
namespace {

/// Calls `visit` for every element of this name, at any depth.
template <class Visit>
void for_each_element(const CPLXMLNode* node, const char* name, Visit& visit) {
  for (; node != nullptr; node = node->psNext) {
    if (node->eType == CXT_Element && std::string(node->pszValue) == name) visit(*node);
    for_each_element(node->psChild, name, visit);
  }
}

std::string text(const CPLXMLNode& node, const char* path, const char* otherwise = "") {
  return CPLGetXMLValue(&node, path, otherwise);
}

std::vector<double> numbers(const std::string& words, std::size_t count,
                            const std::filesystem::path& path, const std::string& what) {
  std::istringstream stream(words);
  std::vector<double> values;
  for (std::string word; stream >> word;)
    values.push_back(number_in_file(word, what, path.string()));
  if (values.size() != count) {
    throw input_error(path, what + " has " + std::to_string(values.size()) + " numbers, not " +
                                std::to_string(count));
  }
  return values;
}

CameraModel camera_of(const CPLXMLNode& sensor, const std::filesystem::path& path) {
  const CPLXMLNode* calibration = nullptr;
  auto take = [&](const CPLXMLNode& node) {
    if (calibration == nullptr || text(node, "class") == "adjusted") calibration = &node;
  };
  for_each_element(sensor.psChild, "calibration", take);
  if (calibration == nullptr) {
    throw input_error(path, "sensor " + text(sensor, "id") + " has no calibration",
                      "export the cameras after the alignment");
  }
  if (text(*calibration, "type", "frame") != "frame") {
    throw input_error(path,
                      "the camera model " + text(*calibration, "type") + " cannot be expressed",
                      "use frame cameras");
  }
  const auto value = [&](const char* name) {
    const std::string word = text(*calibration, name, "0");
    return number_in_file(word, name, path.string());
  };
  CameraModel camera;
  camera.width = checked_side(value("resolution.width"), "width", path.string());
  camera.height = checked_side(value("resolution.height"), "height", path.string());
  camera.fx = value("f") + value("b1");
  camera.fy = value("f");
  camera.cx = 0.5 * camera.width + value("cx") - 0.5;
  camera.cy = 0.5 * camera.height + value("cy") - 0.5;
  camera.k1 = value("k1");
  camera.k2 = value("k2");
  camera.k3 = value("k3");
  camera.p1 = value("p2");
  camera.p2 = value("p1");
  return camera;
}

/// Chunk -> earth: rotation, translation and scale.
struct ChunkTransform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  double scale = 1.0;
};

}  // namespace

ImportedPoses read_metashape(const std::filesystem::path& path) {
  const std::string bytes = read_file(path);
  const XmlTree tree(CPLParseXMLString(bytes.c_str()));
  if (!tree) throw input_error(path, "is no XML");
  std::map<std::string, CameraModel> sensors;
  auto add_sensor = [&](const CPLXMLNode& node) {
    sensors.emplace(text(node, "id"), camera_of(node, path));
  };
  for_each_element(tree.get(), "sensor", add_sensor);
  ImportedPoses result;
  ChunkTransform chunk;
  auto add_chunk = [&](const CPLXMLNode& node) {
    const std::string rotation = text(node, "transform.rotation");
    if (rotation.empty()) return;
    const auto r = numbers(rotation, 9, path, "rotation");
    chunk.rotation << r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8];
    const auto t = numbers(text(node, "transform.translation"), 3, path, "translation");
    chunk.translation = {t[0], t[1], t[2]};
    chunk.scale = number_in_file(text(node, "transform.scale", "1"), "scale", path.string());
    result.frame = PhotoPoseFrame::kGeocentric;
  };
  for_each_element(tree.get(), "chunk", add_chunk);
  auto add_camera = [&](const CPLXMLNode& node) {
    const std::string transform = text(node, "transform");
    const auto sensor = sensors.find(text(node, "sensor_id"));
    if (transform.empty() || sensor == sensors.end()) return;  // not aligned
    const auto m = numbers(transform, 16, path, "transform");
    Eigen::Matrix3d rotation;
    rotation << m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10];
    PhotoPose pose{text(node, "label"), sensor->second, {}};
    const Eigen::Matrix3d turned = chunk.rotation * rotation;
    check_rotation(turned, path.string() + ": the transform of camera " + pose.name);
    pose.map_from_camera.rotation = Eigen::Quaterniond(turned).normalized();
    pose.map_from_camera.translation =
        chunk.scale * (chunk.rotation * Eigen::Vector3d(m[3], m[7], m[11])) + chunk.translation;
    result.poses.push_back(std::move(pose));
  };
  for_each_element(tree.get(), "camera", add_camera);
  if (result.poses.empty()) {
    throw input_error(path, "holds no aligned cameras", "export cameras.xml after the alignment");
  }
  return result;
}

}  // namespace nadir
