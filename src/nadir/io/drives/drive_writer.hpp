// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nadir/core/sensors.hpp"
#include "nadir/core/trajectory.hpp"

namespace nadir {

/// Writes a stereo drive in the layout of KITTI odometry, frame by frame: image_0 and image_1
/// (grey) or image_2 and image_3 (RGB), then, at `finish`, calib.txt, times.txt, mounting.yaml
/// (robot_from_camera, which KITTI has no file for), odometry.tum (the poses given, in the robot's
/// frame) and poses.txt (the same as KITTI has them: of the camera, in the frame of the first).
/// `open_drive` reads all of it back. calib.txt is written last: a folder without it is unfinished.
/// Each file is whole or not there.
class StereoDriveWriter {
 public:
  /// Throws Error (usage) where the rig is not rectified: KITTI has no distortion.
  StereoDriveWriter(std::filesystem::path folder, const StereoRig& rig);
  /// Throws Error (processing) where the frame is not of the rig's size, its stamp does not
  /// increase, or it cannot be written.
  void write(const StereoFrame& frame, const OdomPose3& odom_from_robot);
  /// truth.tum, map_from_robot: `nadir ground` hands it on to the site.
  void write_truth(const Trajectory& truth);
  void finish();

 private:
  std::filesystem::path folder_;
  StereoRig rig_;
  int left_camera_ = 0;  ///< KITTI's number: 0 grey, 2 colour
  std::vector<StampedOdomPose3> poses_;
};

/// The same for a lidar and one camera: velodyne/*.bin (the time within a scan is not kept) and
/// image_0 or image_2.
class LidarDriveWriter {
 public:
  /// Throws Error (usage) where the rig has not exactly one camera, or one with distortion.
  LidarDriveWriter(std::filesystem::path folder, const LidarRig& rig);
  void write(const LidarFrame& frame, const OdomPose3& odom_from_robot);
  void write_truth(const Trajectory& truth);
  void finish();

 private:
  std::filesystem::path folder_;
  LidarRig rig_;
  int camera_ = 0;
  std::vector<StampedOdomPose3> poses_;
};

}  // namespace nadir
