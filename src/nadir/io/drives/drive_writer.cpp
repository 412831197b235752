// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/drive_writer.hpp"

#include <fmt/format.h>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/drives/mounting_file.hpp"
#include "nadir/io/drives/point_cloud.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/trajectories/pose_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

constexpr int kColourCamera = 2;

void check_frame(const path& folder, const Raster<std::uint8_t>& image, const CameraModel& model,
                 Stamp stamp, const std::vector<StampedOdomPose3>& poses) {
  if (image.width() != model.width || image.height() != model.height) {
    throw Error(ErrorKind::kProcessing,
                fmt::format("the image is {} x {} pixels, the camera {} x {}", image.width(),
                            image.height(), model.width, model.height),
                folder.string());
  }
  if (!poses.empty() && stamp <= poses.back().stamp) {
    throw Error(ErrorKind::kProcessing,
                fmt::format("the frame at {} s does not follow {} s", to_string(stamp),
                            to_string(poses.back().stamp)),
                folder.string());
  }
}

path image_file(const path& folder, int camera, std::size_t number) {
  return folder / fmt::format("image_{}", camera) / fmt::format("{:06}.png", number);
}

/// A row of twelve numbers: K [I | (shift, 0, 0)].
std::string projection_row(int camera, const CameraModel& model, double shift_m) {
  return fmt::format("P{}: {:.12e} 0 {:.12e} {:.12e} 0 {:.12e} {:.12e} 0 0 0 1 0\n", camera,
                     model.fx, model.cx, model.fx * shift_m, model.fy, model.cy);
}

/// What both layouts have: times, poses, mounting; nothing is read before calib.txt is there.
void write_common(const path& folder, const std::vector<StampedOdomPose3>& poses,
                  const Mounting& mounting,
                  const Transform3<frames::Robot, frames::Camera>& robot_from_camera) {
  if (poses.empty()) {
    throw Error(ErrorKind::kProcessing, "a drive needs a frame", folder.string());
  }
  std::string times;
  std::vector<Transform3<frames::PoseWorld, frames::PoseSensor>> camera_poses;
  const auto first_from_odom = (poses.front().odom_from_robot * robot_from_camera).inverse();
  for (const StampedOdomPose3& pose : poses) {
    times += to_string(pose.stamp) + "\n";
    const auto motion = first_from_odom * (pose.odom_from_robot * robot_from_camera);
    camera_poses.push_back({motion.rotation, motion.translation});
  }
  write_file(folder / "times.txt", times);
  write_tum(folder / "odometry.tum", poses);
  write_kitti_poses(folder / "poses.txt", camera_poses);
  write_mounting(folder / kMountingFile, mounting);
}

void start(const path& folder) {
  create_folder(folder);
  remove_file(folder / "calib.txt");
}

}  // namespace

StereoDriveWriter::StereoDriveWriter(path folder, const StereoRig& rig)
    : folder_(std::move(folder)), rig_(rig) {
  if (!rig.rectified) {
    throw Error(ErrorKind::kUsage, "KITTI's layout holds rectified images only", folder_.string(),
                "rectify the pairs first");
  }
  start(folder_);
}

void StereoDriveWriter::write(const StereoFrame& frame, const OdomPose3& odom_from_robot) {
  check_frame(folder_, frame.left, rig_.left, frame.stamp, poses_);
  check_frame(folder_, frame.right, rig_.right, frame.stamp, poses_);
  if (poses_.empty()) {
    left_camera_ = frame.left.channels() == 1 ? 0 : kColourCamera;
    for (const int camera : {left_camera_, left_camera_ + 1}) {
      create_folder(image_file(folder_, camera, 0).parent_path());
    }
  }
  write_png(image_file(folder_, left_camera_, poses_.size()), frame.left);
  write_png(image_file(folder_, left_camera_ + 1, poses_.size()), frame.right);
  poses_.push_back({frame.stamp, odom_from_robot});
}

void StereoDriveWriter::write_truth(const Trajectory& truth) {
  write_tum(folder_ / "truth.tum", truth);
}

void StereoDriveWriter::finish() {
  write_common(folder_, poses_, {rig_.robot_from_left, std::nullopt}, rig_.robot_from_left);
  // Cameras 0 and 2 stand in one place, and so do 1 and 3.
  std::string rows;
  for (int camera = 0; camera < 4; ++camera) {
    rows += projection_row(camera, rig_.left, camera % 2 == 0 ? 0.0 : -rig_.baseline_m());
  }
  write_file(folder_ / "calib.txt", rows);
}

LidarDriveWriter::LidarDriveWriter(path folder, const LidarRig& rig)
    : folder_(std::move(folder)), rig_(rig) {
  if (rig.cameras.size() != 1 || rig.cameras.front().model.has_distortion()) {
    throw Error(ErrorKind::kUsage,
                fmt::format("{} cameras: KITTI's layout holds a lidar with one rectified camera",
                            rig.cameras.size()),
                folder_.string(), "give one camera without distortion");
  }
  start(folder_);
}

void LidarDriveWriter::write(const LidarFrame& frame, const OdomPose3& odom_from_robot) {
  if (frame.images.size() != 1) {
    throw Error(ErrorKind::kProcessing, "a frame needs one image", folder_.string());
  }
  const Raster<std::uint8_t>& image = frame.images.front();
  check_frame(folder_, image, rig_.cameras.front().model, frame.stamp, poses_);
  if (poses_.empty()) {
    camera_ = image.channels() == 1 ? 0 : kColourCamera;
    create_folder(folder_ / "velodyne");
    create_folder(image_file(folder_, camera_, 0).parent_path());
  }
  write_velodyne(folder_ / "velodyne" / fmt::format("{:06}.bin", poses_.size()), frame.points);
  write_png(image_file(folder_, camera_, poses_.size()), image);
  poses_.push_back({frame.stamp, odom_from_robot});
}

void LidarDriveWriter::write_truth(const Trajectory& truth) {
  write_tum(folder_ / "truth.tum", truth);
}

void LidarDriveWriter::finish() {
  const MountedCamera& camera = rig_.cameras.front();
  write_common(folder_, poses_, {camera.robot_from_camera, rig_.robot_from_lidar},
               camera.robot_from_camera);
  std::string rows;
  for (int number = 0; number < 4; ++number) rows += projection_row(number, camera.model, 0.0);
  const auto camera_from_lidar = camera.robot_from_camera.inverse() * rig_.robot_from_lidar;
  const Eigen::Matrix3d r = camera_from_lidar.rotation.toRotationMatrix();
  rows += "Tr:";
  for (int row = 0; row < 3; ++row) {
    rows += fmt::format(" {:.12e} {:.12e} {:.12e} {:.12e}", r(row, 0), r(row, 1), r(row, 2),
                        camera_from_lidar.translation(row));
  }
  write_file(folder_ / "calib.txt", rows + "\n");
}

}  // namespace nadir
