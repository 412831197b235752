// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/photo_poses.hpp"

#include <cmath>

#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/detail/pose_formats.hpp"

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
  if (!result.map_from_camera.is_finite()) {
    throw Error(ErrorKind::kInput, "the pose of photo '" + pose.name + "' is no place on the Earth",
                {}, "check the reference point and the translation of the file of poses");
  }
  return result;
}

/// What every format must give, whatever its own reader makes of it: cameras that see, and
/// rotations that are some. A zero quaternion comes through normalized() as it is.
void check_pose(const PhotoPose& pose, const std::filesystem::path& path) {
  constexpr double kAllowed = 1e-2;
  const CameraModel& camera = pose.camera;
  const Eigen::Quaterniond& q = pose.map_from_camera.rotation;
  std::string problem;
  if (!(camera.fx > 0.0) || !(camera.fy > 0.0)) {
    problem = "the focal length of its camera is not above 0";
  } else if (!pose.map_from_camera.is_finite() || !(std::abs(q.norm() - 1.0) <= kAllowed)) {
    problem = "its pose is not finite, or its rotation is none";
  } else {
    return;
  }
  throw input_error(path, "photo '" + pose.name + "': " + problem,
                    "export the poses again, or leave the photo out");
}

ImportedPoses read_by_what_is_there(const std::filesystem::path& path) {
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

}  // namespace

ImportedPoses read_photo_poses(const std::filesystem::path& path) {
  ImportedPoses imported = read_by_what_is_there(path);
  for (const PhotoPose& pose : imported.poses) check_pose(pose, path);
  return imported;
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
