// SPDX-License-Identifier: Apache-2.0
#pragma once

// Drives of a few tiny frames, to be written and read back.

#include <cmath>

#include "nadir/core/random.hpp"
#include "nadir/core/sensors.hpp"
#include "nadir/io/drives/drive_writer.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::test {

inline constexpr int kSmallWidth = 24;
inline constexpr int kSmallHeight = 10;

inline CameraModel small_camera() {
  return {kSmallWidth, kSmallHeight, 20.0, 20.0, 11.5, 4.5, 0, 0, 0, 0, 0};
}

/// A camera 1.5 m up, a little ahead, looking 10 degrees down.
inline Transform3<frames::Robot, frames::Camera> small_mounting() {
  const Eigen::Quaterniond down(Eigen::AngleAxisd(0.17, Eigen::Vector3d::UnitY()));
  return {(down * forward_camera_rotation()).normalized(), {0.3, 0.1, 1.5}};
}

inline StereoRig small_stereo_rig() {
  StereoRig rig;
  rig.left = small_camera();
  rig.right = small_camera();
  rig.right_from_left.translation = {-0.4, 0.0, 0.0};
  rig.robot_from_left = small_mounting();
  rig.rectified = true;
  return rig;
}

inline LidarRig small_lidar_rig() {
  const Eigen::Quaterniond turned(Eigen::AngleAxisd(0.02, Eigen::Vector3d::UnitZ()));
  return {{turned, {0.0, 0.0, 1.8}}, {{small_camera(), small_mounting()}}};
}

inline Raster<std::uint8_t> noise_image(std::uint64_t seed, int channels) {
  Raster<std::uint8_t> image(kSmallWidth, kSmallHeight, 0, channels);
  const RandomStream random(seed, 1);
  for (std::size_t i = 0; i < image.values().size(); ++i) {
    image.values()[i] = static_cast<std::uint8_t>(random.uniform(i, 0.0, 255.0));
  }
  return image;
}

/// Ahead by a metre a frame, in a curve, with a little pitch.
inline OdomPose3 small_pose(int number) {
  const double k = number;
  const Eigen::Quaterniond rotation = Eigen::AngleAxisd(0.05 * k, Eigen::Vector3d::UnitZ()) *
                                      Eigen::AngleAxisd(0.01 * k, Eigen::Vector3d::UnitY());
  return {rotation.normalized(), {10.0 + k, -2.0 + 0.03 * k * k, 0.02 * k}};
}

inline Stamp small_stamp(int number) {
  return {1'403'636'579'763'555'527 + number * 100'000'001LL};
}

inline StereoFrame small_stereo_frame(int number, int channels) {
  const auto seed = static_cast<std::uint64_t>(number);
  return {small_stamp(number), noise_image(2 * seed, channels),
          noise_image(2 * seed + 1, channels)};
}

inline LidarFrame small_lidar_frame(int number) {
  LidarFrame frame{small_stamp(number), {}, {noise_image(static_cast<std::uint64_t>(number), 3)}};
  for (int i = 0; i < 50; ++i) {
    const auto k = static_cast<float>(i + number);
    frame.points.push_back({5.0F + k, -0.1F * k, -1.8F, 0.01F * k, 0.0F});
  }
  return frame;
}

inline void write_small_stereo(const std::filesystem::path& folder, int frames = 4,
                               int channels = 1) {
  StereoDriveWriter writer(folder, small_stereo_rig());
  for (int i = 0; i < frames; ++i) writer.write(small_stereo_frame(i, channels), small_pose(i));
  writer.finish();
}

inline void write_small_lidar(const std::filesystem::path& folder, int frames = 3) {
  LidarDriveWriter writer(folder, small_lidar_rig());
  for (int i = 0; i < frames; ++i) writer.write(small_lidar_frame(i), small_pose(i));
  writer.finish();
}

}  // namespace nadir::test
