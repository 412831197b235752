// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "nadir/io/input_file.hpp"
#include "nadir/io/json.hpp"
#include "nadir/io/photos/detail/pose_formats.hpp"

namespace nadir {
namespace {

using SortedJson = nlohmann::json;  ///< its items come in the order of their names

template <class Document>
Document parsed(const std::filesystem::path& path) {
  try {
    return Document::parse(read_file(path));
  } catch (const typename Document::exception& error) {
    throw input_error(path, std::string("is no JSON: ") + error.what());
  }
}

/// What `read` gives; a missing or wrong item names the file.
template <class Read>
ImportedPoses checked(const std::filesystem::path& path, Read&& read) {
  try {
    return read();
  } catch (const SortedJson::exception& error) {
    throw input_error(path,
                      std::string("an item is missing or of the wrong kind: ") + error.what());
  }
}

template <class Document>
double number(const Document& value, const std::filesystem::path& path) {
  return checked_number(value.template get<double>(), "a number", path.string());
}

double number_or_0(const SortedJson& object, const char* key, const std::filesystem::path& path) {
  return object.contains(key) ? number(object.at(key), path) : 0.0;
}

/// A side of the image: nlohmann would cast whatever number is there.
template <class Document>
int side(const Document& object, const char* key, const std::filesystem::path& path) {
  return checked_side(object.at(key).template get<double>(), key, path.string());
}

/// OpenSfM's cameras: lengths in units of the longer side, from the centre of the image.
CameraModel opensfm_camera(const SortedJson& c, const std::filesystem::path& path) {
  CameraModel camera;
  const std::string type = c.value("projection_type", "perspective");
  camera.width = side(c, "width", path);
  camera.height = side(c, "height", path);
  const double size = std::max(camera.width, camera.height);
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  if (type == "perspective") {
    camera.fx = camera.fy = size * number(c.at("focal"), path);
  } else if (type == "brown") {
    camera.fx = size * number(c.at("focal_x"), path);
    camera.fy = size * number(c.at("focal_y"), path);
    camera.cx += size * number(c.at("c_x"), path);
    camera.cy += size * number(c.at("c_y"), path);
    camera.p1 = number_or_0(c, "p1", path);
    camera.p2 = number_or_0(c, "p2", path);
    camera.k3 = number_or_0(c, "k3", path);
  } else {
    throw input_error(path, "the camera model " + type + " cannot be expressed",
                      "use perspective or brown");
  }
  camera.k1 = number_or_0(c, "k1", path);
  camera.k2 = number_or_0(c, "k2", path);
  return camera;
}

/// Three numbers.
template <class Document>
Eigen::Vector3d vector(const Document& values, const std::filesystem::path& path) {
  return {number(values.at(0), path), number(values.at(1), path), number(values.at(2), path)};
}

ImportedPoses opensfm_poses(const SortedJson& document, const std::filesystem::path& path) {
  const auto largest = std::max_element(document.begin(), document.end(),
                                        [](const SortedJson& a, const SortedJson& b) {
                                          return a.at("shots").size() < b.at("shots").size();
                                        });
  if (largest == document.end() || !largest->at("shots").is_object() ||
      largest->at("shots").empty()) {
    throw input_error(path, "holds no poses");
  }
  ImportedPoses result;
  if (document.size() > 1) {
    result.warnings.push_back(path.string() + ": " + std::to_string(document.size()) +
                              " reconstructions; the largest is taken");
  }
  if (largest->contains("reference_lla")) {
    const SortedJson& lla = largest->at("reference_lla");
    result.frame = PhotoPoseFrame::kTopocentric;
    result.reference =
        GeodeticPosition{number(lla.at("latitude"), path), number(lla.at("longitude"), path),
                         number(lla.at("altitude"), path)};
  }
  for (const auto& [name, shot] : largest->at("shots").items()) {
    const Eigen::Vector3d axis = vector(shot.at("rotation"), path);
    Transform3<frames::Camera, frames::Map> camera_from_map;
    if (axis.norm() > 0.0) {
      camera_from_map.rotation = Eigen::AngleAxisd(axis.norm(), axis.normalized());
    }
    camera_from_map.translation = vector(shot.at("translation"), path);
    const std::string camera = shot.at("camera");
    result.poses.push_back(
        {name, opensfm_camera(largest->at("cameras").at(camera), path), camera_from_map.inverse()});
  }
  return result;
}

}  // namespace

ImportedPoses read_opensfm(const std::filesystem::path& path) {
  const auto document = parsed<SortedJson>(path);
  return checked(path, [&] { return opensfm_poses(document, path); });
}

ImportedPoses read_nadir_poses(const std::filesystem::path& path) {
  const auto document = parsed<Json>(path);
  return checked(path, [&] {
    ImportedPoses result;
    result.frame = PhotoPoseFrame::kMap;
    result.crs = document.at("crs");
    std::vector<CameraModel> cameras;
    for (const Json& c : document.at("cameras")) {
      const auto value = [&](const char* key) { return number(c.at(key), path); };
      cameras.push_back({side(c, "width", path), side(c, "height", path), value("fx"), value("fy"),
                         value("cx"), value("cy"), value("k1"), value("k2"), value("p1"),
                         value("p2"), value("k3")});
    }
    for (const Json& photo : document.at("photos")) {
      const Json& q = photo.at("quaternion");
      const int camera = checked_integer(photo.at("camera").get<double>(), "the camera of a photo",
                                         path.string(), 0, static_cast<int>(cameras.size()) - 1);
      PhotoPose pose{name_at(photo, "name"), cameras[static_cast<std::size_t>(camera)], {}};
      pose.map_from_camera.rotation =
          Eigen::Quaterniond(number(q.at(3), path), number(q.at(0), path), number(q.at(1), path),
                             number(q.at(2), path))
              .normalized();
      pose.map_from_camera.translation = vector(photo.at("position"), path);
      if (photo.contains("flown_in_readout"))
        pose.flown_in_readout = vector(photo.at("flown_in_readout"), path);
      result.poses.push_back(std::move(pose));
    }
    if (result.poses.empty()) throw input_error(path, "holds no poses");
    return result;
  });
}

}  // namespace nadir
