// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "nadir/core/sensors.hpp"

namespace nadir {

/// The layouts of recorded drives; docs/formats.md shows each.
enum class DriveFormat {
  kAuto,          ///< told by what the folder holds
  kKittiStereo,   ///< calib.txt and two folders of images: KITTI odometry
  kKittiLidar,    ///< calib.txt, velodyne/ and image_2 or image_02
  kKittiRaw,      ///< calib_cam_to_cam.txt, image_0N/data, velodyne_points/data
  kEuroc,         ///< mav0/cam0, cam1 with sensor.yaml and data.csv
  kStereoFolder,  ///< two folders of images, OpenCV or Kalibr YAML
  kRosbag,        ///< ROS 1 .bag
};
inline constexpr std::array<std::pair<DriveFormat, const char*>, 7> kDriveFormatNames{
    {{DriveFormat::kAuto, "auto"},
     {DriveFormat::kKittiStereo, "kitti-stereo"},
     {DriveFormat::kKittiLidar, "kitti-lidar"},
     {DriveFormat::kKittiRaw, "kitti-raw"},
     {DriveFormat::kEuroc, "euroc"},
     {DriveFormat::kStereoFolder, "stereo-folder"},
     {DriveFormat::kRosbag, "rosbag"}}};

/// What the poses of a file are of.
enum class PoseFrame {
  kAuto,    ///< KITTI lines: camera; TUM: robot; EuRoC CSV: body
  kCamera,  ///< a camera's, x right, y down, z forward, in a world of such axes
  kRobot,   ///< the robot's, x forward, z up, in a world with z up
  kBody,    ///< EuRoC's body, to which T_BS of the cameras refers, in a world with z up
};
inline constexpr std::array<std::pair<PoseFrame, const char*>, 4> kPoseFrameNames{
    {{PoseFrame::kAuto, "auto"},
     {PoseFrame::kCamera, "camera"},
     {PoseFrame::kRobot, "robot"},
     {PoseFrame::kBody, "body"}}};

/// Which sensor to take of a drive that has both.
enum class DriveSensor { kAuto, kStereo, kLidar };
inline constexpr std::array<std::pair<DriveSensor, const char*>, 3> kDriveSensorNames{
    {{DriveSensor::kAuto, "auto"},
     {DriveSensor::kStereo, "stereo"},
     {DriveSensor::kLidar, "lidar"}}};

/// Topics of a bag; empty = the only ones that fit.
struct BagTopics {
  std::string left;
  std::string right;
  std::string points;
  std::string image;  ///< that colours the points
  std::string odometry;
};

struct DriveReadOptions {
  DriveFormat format = DriveFormat::kAuto;
  DriveSensor sensor = DriveSensor::kAuto;  ///< auto: stereo where there is a pair
  std::filesystem::path poses;              ///< empty = those of the drive
  PoseFrame pose_frame = PoseFrame::kAuto;
  std::filesystem::path mounting;  ///< empty = mounting.yaml of the drive, where it is
  int first = 0;                   ///< position of the first frame
  int count = 0;                   ///< frames to take; 0 = all that follow
  BagTopics topics;
};

/// One instant of a drive; its images or scan are decoded when asked for.
struct DriveFrame {
  int number = 0;  ///< position in the recording, from 0
  Stamp stamp;
  std::vector<std::filesystem::path> files;  ///< left, right; or scan, images; none in a bag
};

/// A recorded drive, opened: calibrations and poses have been read and checked.
struct Drive {
  std::string name;
  DriveFormat format = DriveFormat::kAuto;
  std::variant<StereoRig, LidarRig> rig;
  std::vector<DriveFrame> frames;  ///< at least one; stamps increase
  /// Poses of the robot in the odometry frame, stamps increasing; nothing where the drive has none.
  std::optional<std::vector<StampedOdomPose3>> odometry = std::nullopt;
  std::filesystem::path pose_file;  ///< that they came from: a file, or the bag; may be empty
  std::optional<std::filesystem::path> truth = std::nullopt;  ///< truth.tum: map_from_robot
  std::vector<std::filesystem::path> inputs;                  ///< calibrations and poses read
  std::vector<std::string> notes;                             ///< what was assumed or looks odd

  /// Decodes one frame; the one of the rig that the drive has. What was odd about it is added to
  /// `notes`. Throw Error (input).
  std::function<StereoFrame(const DriveFrame&)> read_stereo;
  std::function<LidarFrame(const DriveFrame&, std::vector<std::string>& notes)> read_lidar;

  bool is_stereo() const { return std::holds_alternative<StereoRig>(rig); }
};

/// Opens a drive. Without mounting.yaml the robot frame has its origin at the (left) camera and
/// its axes level and forward as the camera looks at the first pose; of a lidar drive, it is the
/// lidar's. Throws Error (input) with file, line or frame, value and cure for what is missing or
/// contradictory, (usage) for options that do not fit.
Drive open_drive(const std::filesystem::path& place, const DriveReadOptions& options = {});

/// The layout of a folder or file. Throws Error (input) that lists the known ones where it is none.
DriveFormat guess_drive_format(const std::filesystem::path& place);

/// The pose at an instant: interpolated between two samples at most 0.5 s apart, or the nearest
/// sample within 0.01 s; else nothing.
std::optional<OdomPose3> pose_at(const std::vector<StampedOdomPose3>& poses, Stamp stamp);

}  // namespace nadir
