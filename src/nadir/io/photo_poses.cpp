// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photo_poses.hpp"

#include "nadir/io/detail/pose_formats.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

/// Turns a pose whose frame has geocentric axes into one of the map, which has those of the grid.
PhotoPose from_earth(const PhotoPose& pose, const Eigen::Vector3d& geocentric_centre,
                     const Eigen::Matrix3d& geocentric_from_frame, const MetricFrame& frame) {
  const GeodeticPosition place = from_geocentric(geocentric_centre);
  // East of the grid is turned against true east by the grid convergence.
  const double yaw_of_north = frame.yaw_of_true_heading(0.0, place);
  const Eigen::Matrix3d grid_from_enu =
      Eigen::AngleAxisd(yaw_of_north - M_PI / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Matrix3d map_from_frame =
      grid_from_enu * geocentric_from_enu(place).transpose() * geocentric_from_frame;
  PhotoPose result = pose;
  result.map_from_camera.translation = frame.to_map(place).vector();
  result.map_from_camera.rotation =
      (Eigen::Quaterniond(map_from_frame) * pose.map_from_camera.rotation).normalized();
  result.flown_in_readout = map_from_frame * pose.flown_in_readout;
  return result;
}

}  // namespace

ImportedPoses read_photo_poses(const std::filesystem::path& path) {
  if (is_folder(path)) {
    if (is_file(path / "images.txt")) return read_colmap_model(path);
    if (is_file(path / "reconstruction.json")) return read_opensfm(path / "reconstruction.json");
    throw input_error(path, "holds neither a COLMAP text model nor a reconstruction.json",
                      "for a binary model: colmap model_converter --output_type TXT");
  }
  const std::string bytes = read_file(path);
  if (path.extension() == ".xml") return read_metashape(path);
  if (bytes.find("nadir photo poses 1") < 200) return read_nadir_poses(path);
  if (path.extension() == ".json") return read_opensfm(path);
  throw input_error(path, "is no known list of poses",
                    "give a COLMAP text model, reconstruction.json, cameras.xml or MAP.poses.json");
}

std::vector<PhotoPose> in_map_frame(const ImportedPoses& imported, const MetricFrame& frame) {
  std::vector<PhotoPose> poses;
  for (const PhotoPose& pose : imported.poses) {
    const Eigen::Vector3d& centre = pose.map_from_camera.translation;
    switch (imported.frame) {
      case PhotoPoseFrame::kMap:
        poses.push_back(pose);
        break;
      case PhotoPoseFrame::kGeocentric:
        poses.push_back(from_earth(pose, centre, Eigen::Matrix3d::Identity(), frame));
        break;
      case PhotoPoseFrame::kTopocentric: {
        const Eigen::Matrix3d axes = geocentric_from_enu(imported.reference);
        poses.push_back(
            from_earth(pose, geocentric(imported.reference) + axes * centre, axes, frame));
        break;
      }
      case PhotoPoseFrame::kModel:
        throw Error(ErrorKind::kProcessing, "the poses have no place on the Earth yet");
    }
  }
  return poses;
}

}  // namespace nadir
