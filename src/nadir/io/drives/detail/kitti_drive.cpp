// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>

#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/drives/detail/kitti_calibration.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;
using CameraFromLidar = Transform3<frames::Camera, frames::Lidar>;
using RobotFromCamera = Transform3<frames::Robot, frames::Camera>;

/// "2" for image_2 and image_02, "0" for folders without a number: which projection is theirs.
int camera_number(const path& folder) {
  const std::string name = folder.filename().string();
  const char last = name.back();
  return last >= '0' && last <= '3' ? last - '0' : -1;
}

std::string projection_key(const KittiCalibration& calibration, int camera) {
  std::string key = calibration.first_of(
      {fmt::format("P{}", camera), fmt::format("P_rect_{:02}", camera), "P_rect"});
  if (key.empty()) {
    throw input_error(calibration.file(), fmt::format("has no projection of camera {}", camera),
                      fmt::format("add a row P{}", camera));
  }
  return key;
}

/// Camera folders of one colour camera: colour first.
std::optional<path> find_camera_folder(const path& folder) {
  for (const char* name : {"image_2", "image_02", "image_0", "image_00"}) {
    if (is_folder(folder / name)) return folder / name;
  }
  return std::nullopt;
}

/// Points of the lidar in the rectified frame of camera 0.
CameraFromLidar camera0_from_lidar(const KittiCalibration& calibration) {
  const std::string key =
      calibration.first_of({"Tr", "T_cam_velo", "Tr_velo_to_cam", "Tr_velo_cam"});
  if (key.empty()) {
    throw input_error(calibration.file(), "does not say where the lidar stands",
                      "add a row Tr: camera_from_lidar as a 3x4 matrix");
  }
  const Eigen::Matrix<double, 3, 4> m = calibration.matrix34(key);
  auto camera_from_lidar =
      rigid<frames::Camera, frames::Lidar>(m.leftCols<3>(), m.col(3), calibration.where(key));
  const std::string rectification = calibration.first_of({"R_rect", "R0_rect", "R_rect_00"});
  if (rectification.empty()) return camera_from_lidar;
  return rigid<frames::Camera, frames::Camera>(calibration.matrix33(rectification),
                                               Eigen::Vector3d::Zero(),
                                               calibration.where(rectification)) *
         camera_from_lidar;
}

MountedCamera mounted(const KittiCalibration& calibration, int camera,
                      const RobotFromCamera& robot_from_camera0) {
  const ProjectedCamera projected =
      projected_camera(calibration, projection_key(calibration, camera));
  MountedCamera result{projected.model, robot_from_camera0};
  result.robot_from_camera.translation -=
      robot_from_camera0.rotation * projected.camera_from_camera0;
  return result;
}

/// The file of poses that lies beside: odometry first, as the robot would have it.
path poses_beside(const path& folder) {
  for (const char* name : {"odometry.tum", "poses.txt"}) {
    if (is_file(folder / name)) return folder / name;
  }
  return {};
}

OpenedLayout stereo_layout(const KittiCalibration& calibration, const StereoFolders& folders,
                           const Mounting& mounting) {
  OpenedLayout layout;
  const RobotFromCamera robot_from_camera0 =
      mounting.robot_from_camera.value_or(default_robot_from_camera());
  // A file of two projections is of the two folders there are, whatever their names.
  const int left = calibration.projections() == 2 ? 0 : std::max(camera_number(folders.left), 0);
  layout.drive.rig = kitti_stereo_rig(calibration, projection_key(calibration, left),
                                      projection_key(calibration, left + 1), robot_from_camera0);
  layout.robot_from_pose_camera = robot_from_camera0;
  layout.drive.inputs.push_back(calibration.file());
  return layout;
}

OpenedLayout lidar_layout(const KittiCalibration& calibration,
                          const CameraFromLidar& camera_from_lidar, int camera,
                          const Mounting& mounting) {
  OpenedLayout layout;
  const LidarMounting placed = lidar_mounting(mounting, camera_from_lidar);
  layout.drive.rig =
      LidarRig{placed.robot_from_lidar, {mounted(calibration, camera, placed.robot_from_camera)}};
  layout.robot_from_pose_camera = placed.robot_from_camera;
  layout.drive.inputs.push_back(calibration.file());
  return layout;
}

/// The stamps of a raw drive, of the images by the numbers in their names.
void take_datetimes(const path& file, Drive& drive) {
  const std::vector<Stamp> stamps = read_datetimes(file);
  for (DriveFrame& frame : drive.frames) {
    const std::string stem = frame.files[0].stem().string();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(stem.data(), stem.data() + stem.size(), number);
    if (error != std::errc{} || number >= stamps.size()) {
      throw input_error(file, fmt::format("{} times, none for {}", stamps.size(), stem),
                        "restore the file");
    }
    frame.stamp = stamps[number];
  }
  check_increase(file, drive);
  drive.inputs.push_back(file);
}

}  // namespace

LidarMounting lidar_mounting(const Mounting& mounting, const CameraFromLidar& camera_from_lidar) {
  LidarMounting placed;
  if (mounting.robot_from_lidar) {
    placed.robot_from_lidar = *mounting.robot_from_lidar;
  } else if (mounting.robot_from_camera) {
    placed.robot_from_lidar = *mounting.robot_from_camera * camera_from_lidar;
  }
  placed.robot_from_camera =
      mounting.robot_from_camera.value_or(placed.robot_from_lidar * camera_from_lidar.inverse());
  return placed;
}

OpenedLayout open_kitti_stereo(const path& folder, const Mounting& mounting) {
  const auto folders = find_stereo_folders(folder);
  if (!folders) {
    throw input_error(folder, "holds no pair of image folders",
                      "image_0 and image_1, image_2 and image_3, or image_l and image_r are looked "
                      "for");
  }
  const KittiCalibration calibration(folder / "calib.txt");
  OpenedLayout layout = stereo_layout(calibration, *folders, mounting);
  layout.drive.frames =
      paired(folders->left, DriveFiles::kImages, folders->right, DriveFiles::kImages);
  take_times(folder / "times.txt", layout.drive);
  layout.poses = poses_beside(folder);
  return layout;
}

OpenedLayout open_kitti_lidar(const path& folder, const Mounting& mounting) {
  const auto camera = find_camera_folder(folder);
  if (!camera || !is_folder(folder / "velodyne")) {
    throw input_error(folder, camera ? "holds no folder velodyne" : "holds no folder image_2",
                      "scans lie in velodyne, the images that colour them in image_2 or image_02");
  }
  const KittiCalibration calibration(folder / "calib.txt");
  OpenedLayout layout =
      lidar_layout(calibration, camera0_from_lidar(calibration), camera_number(*camera), mounting);
  layout.drive.frames =
      paired(folder / "velodyne", DriveFiles::kScans, *camera, DriveFiles::kImages);
  take_times(folder / "times.txt", layout.drive);
  layout.poses = poses_beside(folder);
  return layout;
}

OpenedLayout open_kitti_raw(const path& folder, const Mounting& mounting, DriveSensor sensor) {
  const path place =
      is_file(folder / "calib_cam_to_cam.txt") ? folder : path(folder / "..").lexically_normal();
  const KittiCalibration calibration(place / "calib_cam_to_cam.txt");
  const auto folders = find_stereo_folders(folder);
  const bool stereo = sensor == DriveSensor::kStereo || (sensor == DriveSensor::kAuto && folders);
  OpenedLayout layout;
  path first = folder / "velodyne_points";
  path second;
  if (stereo) {
    if (!folders) throw input_error(folder, "holds no pair of cameras", "give --sensor lidar");
    layout = stereo_layout(calibration, *folders, mounting);
    first = folders->left;
    second = folders->right;
  } else {
    const auto camera = find_camera_folder(folder);
    if (!camera || !is_folder(first)) {
      throw input_error(folder, "holds no velodyne_points with image_02 or image_00",
                        "a raw drive has a pair of cameras, or a lidar and a camera");
    }
    const KittiCalibration velodyne(place / "calib_velo_to_cam.txt");
    const auto camera_from_lidar =
        rigid<frames::Camera, frames::Camera>(calibration.matrix33("R_rect_00"),
                                              Eigen::Vector3d::Zero(),
                                              calibration.where("R_rect_00")) *
        rigid<frames::Camera, frames::Lidar>(velodyne.matrix33("R"), velodyne.vector3("T"),
                                             velodyne.where("R"));
    layout = lidar_layout(calibration, camera_from_lidar, camera_number(*camera), mounting);
    layout.drive.inputs.push_back(velodyne.file());
    second = *camera;
  }
  layout.drive.frames = paired(first / "data", stereo ? DriveFiles::kImages : DriveFiles::kScans,
                               second / "data", DriveFiles::kImages);
  take_datetimes(first / "timestamps.txt", layout.drive);
  layout.poses = poses_beside(folder);
  return layout;
}

}  // namespace nadir
