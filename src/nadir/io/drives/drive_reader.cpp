// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/drive_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

Mounting mounting_of(const path& drive, const DriveReadOptions& options) {
  if (!options.mounting.empty()) return read_mounting(options.mounting);
  const path beside = drive / kMountingFile;
  return is_file(beside) ? read_mounting(beside) : Mounting{};
}

OpenedLayout open_layout(const path& place, DriveFormat format, const DriveReadOptions& options) {
  const Mounting mounting = mounting_of(place, options);
  switch (format) {
    case DriveFormat::kKittiStereo:
      return open_kitti_stereo(place, mounting);
    case DriveFormat::kKittiLidar:
      return open_kitti_lidar(place, mounting);
    case DriveFormat::kKittiRaw:
      return open_kitti_raw(place, mounting, options.sensor);
    case DriveFormat::kEuroc:
      return open_euroc(place, mounting);
    case DriveFormat::kRosbag:
      return open_rosbag(place, mounting, options);
    default:
      return open_stereo_folder(place, mounting);
  }
}

/// Gaps are said and not refused: a recording may pause, and the mapper takes any step of time.
void note_gap(Drive& drive) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < drive.frames.size(); ++i) {
    steps.push_back(drive.frames[i].stamp.nanoseconds - drive.frames[i - 1].stamp.nanoseconds);
  }
  if (steps.size() < 3) return;
  std::vector<std::int64_t> sorted = steps;
  std::ranges::sort(sorted);
  const std::int64_t median = sorted[sorted.size() / 2];
  const auto longest = std::ranges::max_element(steps);
  const auto gaps = std::ranges::count_if(steps, [&](auto step) { return step / 2 > median; });
  if (gaps == 0) return;
  const auto before = static_cast<std::size_t>(longest - steps.begin());
  drive.notes.push_back(fmt::format(
      "{} gaps in time; the longest, {} s after frame {}, is {:.1f} times the usual {} "
      "s: are frames missing?",
      gaps, to_string(Stamp{*longest}), drive.frames[before].number,
      static_cast<double>(*longest) / static_cast<double>(median), to_string(Stamp{median})));
}

void select_frames(Drive& drive, const DriveReadOptions& options) {
  const int there = static_cast<int>(drive.frames.size());
  if (options.first >= there) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the drive has {} frames, 0 to {}", there, there - 1),
                fmt::format("--first {}", options.first), "give a smaller number");
  }
  const int count = options.count > 0 ? options.count : there;
  const int last = std::min(there, options.first + std::min(count, there));
  drive.frames.erase(drive.frames.begin() + last, drive.frames.end());
  drive.frames.erase(drive.frames.begin(), drive.frames.begin() + options.first);
}

PoseFrame frame_of(const PoseFile& file, PoseFrame asked) {
  if (asked != PoseFrame::kAuto) return asked;
  switch (file.kind) {
    case PoseFileKind::kKitti:
      return PoseFrame::kCamera;
    case PoseFileKind::kEuroc:
      return PoseFrame::kBody;
    default:
      return PoseFrame::kRobot;
  }
}

OdomPose3 robot_pose(const FilePose& pose, PoseFrame frame, const OpenedLayout& layout,
                     const path& file) {
  const auto& [rotation, translation] = pose.world_from_sensor;
  if (frame == PoseFrame::kRobot) return {rotation, translation};
  if (frame == PoseFrame::kCamera) {
    // Into the camera, along its motion, and out again.
    const auto& mounted = layout.robot_from_pose_camera;
    const Transform3<frames::Camera, frames::Camera> motion{rotation, translation};
    const auto result = mounted * motion * mounted.inverse();
    return {result.rotation, result.translation};
  }
  if (!layout.robot_from_body) {
    throw Error(ErrorKind::kUsage, "this drive has no body that poses could be of", file.string(),
                "give --pose-frame camera or robot");
  }
  const auto world_from_robot = pose.world_from_sensor * layout.robot_from_body->inverse();
  return {world_from_robot.rotation, world_from_robot.translation};
}

/// How a robot seems to move in its own frame, in sums over the drive.
struct Travel {
  double forward = 0.0;
  double sideways = 0.0;
  double up = 0.0;
};

Travel travel_of(const std::vector<StampedOdomPose3>& poses) {
  Travel travel;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const OdomPose3& before = poses[i - 1].odom_from_robot;
    const Eigen::Vector3d step =
        before.rotation.conjugate() * (poses[i].odom_from_robot.translation - before.translation);
    travel.forward += std::abs(step.x());
    travel.sideways += std::abs(step.y());
    travel.up += std::abs(step.z());
  }
  return travel;
}

/// A ground robot neither climbs like a lift nor goes like a crab: poses of another frame do.
void check_travel(const std::vector<StampedOdomPose3>& poses, PoseFrame frame, bool asked,
                  const path& file, Drive& drive) {
  constexpr double kEnoughM = 2.0;
  const Travel travel = travel_of(poses);
  const double level = std::max(travel.forward, travel.sideways);
  if (std::max(level, travel.up) < kEnoughM) return;
  const char* other = frame == PoseFrame::kCamera ? "robot" : "camera";
  const char* looks = frame == PoseFrame::kCamera ? "x-forward, z-up" : "z-forward, y-down";
  const std::string problem = fmt::format(
      "the poses look like {}: taken as {} poses, the robot goes {:.1f} m ahead, {:.1f} m sideways "
      "and {:.1f} m up",
      looks, frame == PoseFrame::kCamera ? "camera" : "robot", travel.forward, travel.sideways,
      travel.up);
  const bool climbs = travel.up > 2.0 * level;
  if (climbs || (travel.sideways > 2.0 * travel.forward && !asked)) {
    throw input_error(file, problem, fmt::format("give --pose-frame {}", other));
  }
  if (travel.sideways > 2.0 * travel.forward) drive.notes.push_back(file.string() + ": " + problem);
}

/// Rows without stamps belong to the frames in turn: to all of the drive, or to those asked for.
void stamp_rows(PoseFile& file, const std::vector<DriveFrame>& all,
                const std::vector<DriveFrame>& asked, const path& path_of_file) {
  if (file.kind != PoseFileKind::kKitti) return;
  const auto& frames = file.poses.size() == all.size() ? all : asked;
  if (file.poses.size() != frames.size()) {
    throw input_error(path_of_file,
                      fmt::format("{} poses for {} frames", file.poses.size(), all.size()),
                      "give one row a frame, or the frames that have poses: --first N --count M");
  }
  for (std::size_t i = 0; i < frames.size(); ++i) file.poses[i].stamp = frames[i].stamp;
}

void take_poses(OpenedLayout& layout, PoseFile file, const path& path_of_file,
                const std::vector<DriveFrame>& all, PoseFrame asked) {
  stamp_rows(file, all, layout.drive.frames, path_of_file);
  const PoseFrame frame = frame_of(file, asked);
  std::vector<StampedOdomPose3> poses;
  for (const FilePose& pose : file.poses) {
    poses.push_back({*pose.stamp, robot_pose(pose, frame, layout, path_of_file)});
  }
  check_travel(poses, frame, asked != PoseFrame::kAuto, path_of_file, layout.drive);
  layout.drive.odometry = std::move(poses);
  layout.drive.pose_file = path_of_file;
}

std::string name_of(const path& place) {
  const path normal = std::filesystem::weakly_canonical(place);
  return normal.has_filename() ? normal.filename().string()
                               : normal.parent_path().filename().string();
}

}  // namespace

DriveFormat guess_drive_format(const path& place) {
  if (is_file(place) && place.extension() == ".bag") return DriveFormat::kRosbag;
  if (!is_folder(place)) {
    throw input_error(place, is_file(place) ? "is no recorded drive" : "no such file or folder",
                      "give the folder of a drive, or a .bag");
  }
  if (is_file(place / "mav0" / "cam0" / "sensor.yaml") || is_file(place / "cam0" / "sensor.yaml")) {
    return DriveFormat::kEuroc;
  }
  if (is_file(place / "calib_cam_to_cam.txt") ||
      (is_folder(place / "image_00" / "data") || is_folder(place / "image_02" / "data"))) {
    return DriveFormat::kKittiRaw;
  }
  const bool stereo = find_stereo_folders(place).has_value();
  if (is_file(place / "calib.txt")) {
    return stereo ? DriveFormat::kKittiStereo : DriveFormat::kKittiLidar;
  }
  if (stereo) return DriveFormat::kStereoFolder;
  throw input_error(place, "is of no known layout",
                    "docs/formats.md lists them: KITTI (calib.txt), KITTI raw, EuRoC (mav0), two "
                    "image folders with a YAML calibration, ROS 1 .bag");
}

Drive open_drive(const path& place, const DriveReadOptions& options) {
  DriveFormat format =
      options.format == DriveFormat::kAuto ? guess_drive_format(place) : options.format;
  if (format == DriveFormat::kKittiStereo && options.sensor == DriveSensor::kLidar) {
    format = DriveFormat::kKittiLidar;
  }
  OpenedLayout layout = open_layout(place, format, options);
  Drive& drive = layout.drive;
  drive.name = name_of(place);
  drive.format = format;
  if (format != DriveFormat::kRosbag) {
    take_image_sizes(drive);
    drive.is_stereo() ? read_stereo_from_files(drive) : read_lidar_from_files(drive);
  }
  const std::vector<DriveFrame> all = drive.frames;
  select_frames(drive, options);
  note_gap(drive);
  const path poses = options.poses.empty() ? layout.poses : options.poses;
  if (!poses.empty()) {
    take_poses(layout, read_pose_file(poses), poses, all, options.pose_frame);
    drive.inputs.push_back(poses);
  } else if (layout.recorded_poses) {
    take_poses(layout, *std::move(layout.recorded_poses), place, all, options.pose_frame);
  }
  if (const path truth = place / "truth.tum"; is_file(truth)) drive.truth = truth;
  return std::move(layout.drive);
}

std::optional<OdomPose3> pose_at(const std::vector<StampedOdomPose3>& poses, Stamp stamp) {
  constexpr std::int64_t kLargestGap = 500'000'000;        // nanoseconds
  constexpr std::int64_t kLargestDifference = 10'000'000;  // nanoseconds
  const auto after = std::ranges::lower_bound(poses, stamp, {}, &StampedOdomPose3::stamp);
  if (after != poses.end() && after->stamp == stamp) return after->odom_from_robot;
  const auto before = after == poses.begin() ? after : std::prev(after);
  if (after != poses.end() && after != before &&
      after->stamp.nanoseconds - before->stamp.nanoseconds <= kLargestGap) {
    const double share = static_cast<double>(stamp.nanoseconds - before->stamp.nanoseconds) /
                         static_cast<double>(after->stamp.nanoseconds - before->stamp.nanoseconds);
    const OdomPose3& a = before->odom_from_robot;
    const OdomPose3& b = after->odom_from_robot;
    return OdomPose3{a.rotation.slerp(share, b.rotation),
                     a.translation + share * (b.translation - a.translation)};
  }
  for (auto it = before; it != poses.end() && it <= after; ++it) {
    if (std::abs(it->stamp.nanoseconds - stamp.nanoseconds) <= kLargestDifference) {
      return it->odom_from_robot;
    }
  }
  return std::nullopt;
}

}  // namespace nadir
