// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "nadir/io/detail/pose_formats.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/json.hpp"

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

/// OpenSfM's cameras: lengths in units of the longer side, from the centre of the image.
CameraModel opensfm_camera(const SortedJson& c, const std::filesystem::path& path) {
  CameraModel camera;
  const std::string type = c.value("projection_type", "perspective");
  camera.width = c.at("width");
  camera.height = c.at("height");
  const double size = std::max(camera.width, camera.height);
  camera.cx = 0.5 * (camera.width - 1);
  camera.cy = 0.5 * (camera.height - 1);
  if (type == "perspective") {
    camera.fx = camera.fy = size * c.at("focal").get<double>();
  } else if (type == "brown") {
    camera.fx = size * c.at("focal_x").get<double>();
    camera.fy = size * c.at("focal_y").get<double>();
    camera.cx += size * c.at("c_x").get<double>();
    camera.cy += size * c.at("c_y").get<double>();
    camera.p1 = c.value("p1", 0.0);
    camera.p2 = c.value("p2", 0.0);
    camera.k3 = c.value("k3", 0.0);
  } else {
    throw input_error(path, "the camera model " + type + " cannot be expressed",
                      "use perspective or brown");
  }
  camera.k1 = c.value("k1", 0.0);
  camera.k2 = c.value("k2", 0.0);
  return camera;
}

Eigen::Vector3d vector(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

ImportedPoses opensfm_poses(const SortedJson& document, const std::filesystem::path& path) {
  const auto largest = std::max_element(document.begin(), document.end(),
                                        [](const SortedJson& a, const SortedJson& b) {
                                          return a.at("shots").size() < b.at("shots").size();
                                        });
  if (largest == document.end() || largest->at("shots").empty()) {
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
        GeodeticPosition{lla.at("latitude"), lla.at("longitude"), lla.at("altitude")};
  }
  for (const auto& [name, shot] : largest->at("shots").items()) {
    const Eigen::Vector3d axis = vector(shot.at("rotation"));
    Transform3<frames::Camera, frames::Map> camera_from_map;
    if (axis.norm() > 0.0) {
      camera_from_map.rotation = Eigen::AngleAxisd(axis.norm(), axis.normalized());
    }
    camera_from_map.translation = vector(shot.at("translation"));
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
      cameras.push_back({c.at("width"), c.at("height"), c.at("fx"), c.at("fy"), c.at("cx"),
                         c.at("cy"), c.at("k1"), c.at("k2"), c.at("p1"), c.at("p2"), c.at("k3")});
    }
    for (const Json& photo : document.at("photos")) {
      const Json& q = photo.at("quaternion");
      PhotoPose pose{name_at(photo, "name"), cameras.at(photo.at("camera").get<std::size_t>()), {}};
      pose.map_from_camera.rotation =
          Eigen::Quaterniond(q.at(3).get<double>(), q.at(0).get<double>(), q.at(1).get<double>(),
                             q.at(2).get<double>())
              .normalized();
      pose.map_from_camera.translation = vector(photo.at("position"));
      if (photo.contains("flown_in_readout"))
        pose.flown_in_readout = vector(photo.at("flown_in_readout"));
      result.poses.push_back(std::move(pose));
    }
    if (result.poses.empty()) throw input_error(path, "holds no poses");
    return result;
  });
}

}  // namespace nadir
