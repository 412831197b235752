// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the layouts of drives share. Each opens its folder into an OpenedLayout; drive_reader.cpp
// makes a Drive of it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/io/drives/drive_reader.hpp"
#include "nadir/io/drives/mounting_file.hpp"
#include "nadir/io/trajectories/pose_file.hpp"

namespace nadir {

/// A drive whose poses have not been looked at yet.
struct OpenedLayout {
  Drive drive;
  /// The file of poses that the layout has, where it has any.
  std::filesystem::path poses;
  /// The poses that are recorded with the images.
  std::optional<PoseFile> recorded_poses = std::nullopt;
  /// Of the camera that camera poses are of.
  Transform3<frames::Robot, frames::Camera> robot_from_pose_camera;
  /// EuRoC: of the body that its poses are of.
  std::optional<Transform3<frames::Robot, frames::PoseSensor>> robot_from_body = std::nullopt;
};

OpenedLayout open_kitti_stereo(const std::filesystem::path& folder, const Mounting& mounting);
OpenedLayout open_kitti_lidar(const std::filesystem::path& folder, const Mounting& mounting);
OpenedLayout open_kitti_raw(const std::filesystem::path& folder, const Mounting& mounting,
                            DriveSensor sensor);
OpenedLayout open_euroc(const std::filesystem::path& given, const Mounting& mounting);
OpenedLayout open_stereo_folder(const std::filesystem::path& folder, const Mounting& mounting);
OpenedLayout open_rosbag(const std::filesystem::path& file, const Mounting& mounting,
                         const DriveReadOptions& options);

/// The mounting of a lidar and of camera 0, from what is said of either; without them
/// the robot frame is the lidar's.
struct LidarMounting {
  Transform3<frames::Robot, frames::Lidar> robot_from_lidar;
  Transform3<frames::Robot, frames::Camera> robot_from_camera;
};
LidarMounting lidar_mounting(const Mounting& mounting,
                             const Transform3<frames::Camera, frames::Lidar>& camera_from_lidar);

/// Two folders of images that are there, of the pairs of names in use ("image_2", "image_3", …);
/// colour first. Nothing where there is none.
struct StereoFolders {
  std::filesystem::path left;
  std::filesystem::path right;
};
std::optional<StereoFolders> find_stereo_folders(const std::filesystem::path& folder);

/// The images (PNG, JPEG, TIFF, PGM) or scans (.bin, .pcd, .ply) of a folder, sorted by name.
enum class DriveFiles { kImages, kScans };
std::vector<std::filesystem::path> files_of(const std::filesystem::path& folder, DriveFiles kind);

/// Pairs files by the number at the end of their names. Throws Error (input) that names the file
/// without a partner, and both counts.
std::vector<DriveFrame> paired(const std::filesystem::path& first_folder, DriveFiles first_kind,
                               const std::filesystem::path& second_folder, DriveFiles second_kind);

/// Gives the frames the stamps of times.txt (decimal seconds, one a line) where it is there, else
/// those of 10 Hz, and notes so. Throws Error (input) where counts differ or stamps do not
/// increase.
void take_times(const std::filesystem::path& file, Drive& drive);

/// Throws Error (input) that names `file` and the frame where the stamps do not increase.
void check_increase(const std::filesystem::path& file, const Drive& drive);

/// The stamps of a KITTI raw timestamps.txt: "2011-09-26 13:02:25.964389445".
std::vector<Stamp> read_datetimes(const std::filesystem::path& file);

/// The robot frame where nothing is said: at the camera, level, forward.
Transform3<frames::Robot, frames::Camera> default_robot_from_camera();

/// Sets read_stereo so that it decodes files; checks sizes against the rig.
void read_stereo_from_files(Drive& drive);
void read_lidar_from_files(Drive& drive);

/// Checks a rig as soon as it is known: focal lengths, baseline, its sign. `where` names the
/// calibration. Throws Error (input).
void check_rig(const StereoRig& rig, const std::string& where);

/// Widths and heights that the calibration does not give, of the first images.
void take_image_sizes(Drive& drive);

/// Checks the images of a pair. Throws Error (input) that names both files and sizes.
void check_pair(const StereoFrame& frame, const StereoRig& rig, const std::string& left,
                const std::string& right);

}  // namespace nadir
