// SPDX-License-Identifier: Apache-2.0
#include "end_to_end/small_drive.hpp"

#include <cmath>

#include "end_to_end/nadir_process.hpp"
#include "nadir/core/random.hpp"
#include "nadir/io/drives/drive_writer.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 320;
constexpr int kHeight = 160;
constexpr double kFocalPx = 200.0;
constexpr double kBaselineM = 0.3;
constexpr double kCameraHeightM = 1.2;
constexpr double kPitchRad = 0.30;

/// Noise on a lattice, bilinear between its points: 0 .. 1.
class Noise {
 public:
  Noise(double cell_m, std::uint64_t seed) : cell_m_(cell_m), lattice_(kSide, kSide) {
    const RandomStream random(seed, 9);
    for (std::size_t i = 0; i < lattice_.values().size(); ++i) {
      lattice_.values()[i] = random.uniform(i, 0.0, 1.0);
    }
  }

  double at(double x, double y) const {
    const double u = x / cell_m_ + kSide / 2.0;
    const double v = y / cell_m_ + kSide / 2.0;
    const int i = static_cast<int>(std::floor(u));
    const int j = static_cast<int>(std::floor(v));
    const auto value = [&](int a, int b) {
      return lattice_.at(std::clamp(a, 0, kSide - 1), std::clamp(b, 0, kSide - 1));
    };
    const double a = u - i;
    const double b = v - j;
    return (1 - b) * ((1 - a) * value(i, j) + a * value(i + 1, j)) +
           b * ((1 - a) * value(i, j + 1) + a * value(i + 1, j + 1));
  }

 private:
  static constexpr int kSide = 512;
  double cell_m_;
  Raster<double> lattice_;
};

std::uint8_t ground_at(double x, double y) {
  static const Noise fine(0.15, 1);
  static const Noise middle(0.6, 2);
  static const Noise coarse(3.0, 3);
  const double value = 0.4 * fine.at(x, y) + 0.35 * middle.at(x, y) + 0.25 * coarse.at(x, y);
  return static_cast<std::uint8_t>(std::lround(30.0 + 200.0 * value));
}

/// In the frame of the map, whose axes the odometry shares.
Pose2 true_pose(int number) {
  const double s = kSmallDriveStepM * number;
  constexpr double kCurvature = 0.03;  // 1/m
  const double yaw = 0.4 + kCurvature * s;
  return {-3.0 + (std::sin(yaw) - std::sin(0.4)) / kCurvature,
          -2.0 + (std::cos(0.4) - std::cos(yaw)) / kCurvature, yaw};
}

Raster<std::uint8_t> view_of(int number, double shift_m) {
  const Transform3<frames::Odom, frames::Robot> robot = small_drive_pose(number);
  auto pose = robot * small_drive_rig().robot_from_left;
  pose.translation += pose.rotation * Eigen::Vector3d(shift_m, 0.0, 0.0);
  const CameraModel model = small_drive_rig().left;
  Raster<std::uint8_t> image(kWidth, kHeight, 200);  // sky without texture
  for (int row = 0; row < kHeight; ++row) {
    for (int column = 0; column < kWidth; ++column) {
      const Eigen::Vector3d ray =
          pose.rotation * model.ray({static_cast<double>(column), static_cast<double>(row)});
      if (ray.z() > -1e-3) continue;
      const Eigen::Vector3d p = pose.translation - pose.translation.z() / ray.z() * ray;
      image.at(column, row) = ground_at(p.x(), p.y());
    }
  }
  return image;
}

fs::path write_small_drive() {
  const fs::path folder = scratch_folder() / "drive";
  StereoDriveWriter writer(folder, small_drive_rig());
  Trajectory truth;
  for (int i = 0; i < kSmallDriveFrames; ++i) {
    const StereoFrame frame = small_drive_frame(i);
    writer.write(frame, small_drive_pose(i));
    truth.push_back({frame.stamp, true_pose(i)});
  }
  writer.write_truth(truth);
  writer.finish();
  return folder;
}

fs::path write_map() {
  constexpr double kHalfM = 24.0;
  constexpr double kResolutionM = 0.1;
  const int side = static_cast<int>(std::lround(2.0 * kHalfM / kResolutionM));
  Orthomosaic map{Raster<std::uint8_t>(side, side),
                  Raster<std::uint8_t>(side, side, 255),
                  {-kHalfM, kHalfM, kResolutionM, {}}};
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      map.image.at(column, row) = ground_at(map.geo.x_at(column + 0.5), map.geo.y_at(row + 0.5));
    }
  }
  const fs::path file = scratch_folder() / "plane.tif";
  write_orthomosaic(file, map);
  return file;
}

}  // namespace

StereoRig small_drive_rig() {
  StereoRig rig;
  rig.left = {kWidth, kHeight, kFocalPx, kFocalPx, 159.5, 79.5, 0, 0, 0, 0, 0};
  rig.right = rig.left;
  rig.right_from_left.translation = {-kBaselineM, 0.0, 0.0};
  const Eigen::Quaterniond down(Eigen::AngleAxisd(kPitchRad, Eigen::Vector3d::UnitY()));
  rig.robot_from_left = {down * forward_camera_rotation(), {0.2, 0.0, kCameraHeightM}};
  rig.rectified = true;
  return rig;
}

OdomPose3 small_drive_pose(int number) {
  const Pose2 pose = true_pose(number);
  return spatial(OdomPose2{pose.x, pose.y, pose.yaw});
}

StereoFrame small_drive_frame(int number) {
  return {{100'000'000'000 + number * 250'000'000LL},
          view_of(number, 0.0),
          view_of(number, kBaselineM)};
}

fs::path small_drive() {
  static const fs::path folder = write_small_drive();
  return folder;
}

fs::path copy_of_small_drive(const std::string& name) {
  const fs::path copy = scratch_folder() / name;
  fs::copy(small_drive(), copy, fs::copy_options::recursive);
  return copy;
}

fs::path small_drive_map() {
  static const fs::path file = write_map();
  return file;
}

}  // namespace nadir::testing
