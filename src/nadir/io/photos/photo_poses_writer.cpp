// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/json.hpp"
#include "nadir/io/photos/photo_poses.hpp"

namespace nadir {
namespace {

Json to_json(const CameraModel& c) {
  return {{"width", c.width}, {"height", c.height}, {"fx", c.fx}, {"fy", c.fy},
          {"cx", c.cx},       {"cy", c.cy},         {"k1", c.k1}, {"k2", c.k2},
          {"p1", c.p1},       {"p2", c.p2},         {"k3", c.k3}};
}

}  // namespace

void write_photo_poses(const std::filesystem::path& path, std::span<const PhotoPose> poses,
                       const std::string& crs) {
  std::vector<CameraModel> cameras;
  Json photos = Json::array();
  for (const PhotoPose& pose : poses) {
    std::size_t camera = 0;
    while (camera < cameras.size() && !(cameras[camera] == pose.camera)) ++camera;
    if (camera == cameras.size()) cameras.push_back(pose.camera);
    const Eigen::Vector3d& t = pose.map_from_camera.translation;
    const Eigen::Quaterniond& q = pose.map_from_camera.rotation;
    Json photo = Json::object();
    set_name(photo, "name", pose.name);
    photo["camera"] = camera;
    photo["position"] = {t.x(), t.y(), t.z()};
    photo["quaternion"] = {q.x(), q.y(), q.z(), q.w()};
    const Eigen::Vector3d& flown = pose.flown_in_readout;
    if (!flown.isZero()) photo["flown_in_readout"] = {flown.x(), flown.y(), flown.z()};
    photos.push_back(std::move(photo));
  }
  Json document{{"format", "nadir photo poses 1"}, {"crs", crs}};
  document["cameras"] = Json::array();
  for (const CameraModel& camera : cameras) document["cameras"].push_back(to_json(camera));
  document["photos"] = std::move(photos);
  write_file(path, json_text(document, 1) + "\n");
}

CameraModel resized(const CameraModel& camera, int width, int height) {
  CameraModel result = camera;
  const double x = static_cast<double>(width) / camera.width;
  const double y = static_cast<double>(height) / camera.height;
  result.width = width;
  result.height = height;
  result.fx *= x;
  result.fy *= y;
  result.cx = (camera.cx + 0.5) * x - 0.5;  // pixel centres keep their distance from the edge
  result.cy = (camera.cy + 0.5) * y - 0.5;
  return result;
}

}  // namespace nadir
