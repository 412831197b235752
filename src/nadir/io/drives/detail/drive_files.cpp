// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <map>

#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/drives/point_cloud.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

/// What two files of one instant have in common: the digits at the end of their names; all of the
/// name where there are none.
std::string key_of(const path& file) {
  const std::string stem = file.stem().string();
  const std::size_t last = stem.find_last_not_of("0123456789");
  const std::size_t digits = last == std::string::npos ? 0 : last + 1;
  return digits == stem.size() ? stem : stem.substr(digits);
}

std::map<std::string, path> by_key(const std::vector<path>& files) {
  std::map<std::string, path> keyed;
  for (const path& file : files) {
    const auto [entry, added] = keyed.emplace(key_of(file), file);
    if (!added) {
      throw input_error(file, "has the same number as " + entry->second.string(),
                        "keep one image a number");
    }
  }
  return keyed;
}

bool is_finite(const CameraModel& camera) {
  return std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy + camera.k1 + camera.k2 +
                       camera.p1 + camera.p2 + camera.k3);
}

std::string size_of(const Raster<std::uint8_t>& image) {
  return fmt::format("{} x {}", image.width(), image.height());
}

}  // namespace

void check_increase(const path& file, const Drive& drive) {
  for (std::size_t i = 1; i < drive.frames.size(); ++i) {
    const Stamp before = drive.frames[i - 1].stamp;
    const Stamp now = drive.frames[i].stamp;
    if (now > before) continue;
    throw input_error(file,
                      fmt::format("the time of frame {} is {}, not later than {} of frame {}", i,
                                  to_string(now), to_string(before), i - 1),
                      "correct the times, or remove the frame");
  }
}

std::vector<path> files_of(const path& folder, DriveFiles kind) {
  static constexpr std::array kImages{".png", ".jpg", ".jpeg", ".tif", ".tiff", ".pgm", ".ppm"};
  static constexpr std::array kScans{".bin", ".pcd", ".ply"};
  std::vector<path> files = files_in(folder, Depth::kFolder);
  std::erase_if(files, [&](const path& file) {
    const std::string extension = lower_extension(file);
    return kind == DriveFiles::kImages ? std::ranges::find(kImages, extension) == kImages.end()
                                       : std::ranges::find(kScans, extension) == kScans.end();
  });
  if (files.empty()) {
    throw input_error(folder, kind == DriveFiles::kImages ? "holds no image" : "holds no scan",
                      kind == DriveFiles::kImages ? "give PNG, JPEG, TIFF or PGM files"
                                                  : "give .bin, .pcd or .ply files");
  }
  return files;
}

std::optional<StereoFolders> find_stereo_folders(const path& folder) {
  static constexpr std::array<std::pair<const char*, const char*>, 7> kNames{
      {{"image_2", "image_3"},
       {"image_02", "image_03"},
       {"image_0", "image_1"},
       {"image_00", "image_01"},
       {"image_l", "image_r"},
       {"image_left", "image_right"},
       {"left", "right"}}};
  for (const auto& [left, right] : kNames) {
    if (is_folder(folder / left) && is_folder(folder / right)) {
      return StereoFolders{folder / left, folder / right};
    }
  }
  return std::nullopt;
}

std::vector<DriveFrame> paired(const path& first_folder, DriveFiles first_kind,
                               const path& second_folder, DriveFiles second_kind) {
  const std::vector<path> first = files_of(first_folder, first_kind);
  const auto second = by_key(files_of(second_folder, second_kind));
  const auto counts = fmt::format("{} holds {} files, {} {}", first_folder.string(), first.size(),
                                  second_folder.string(), second.size());
  const auto keyed = by_key(first);
  for (const auto& [key, file] : second) {
    if (keyed.contains(key)) continue;
    throw input_error(file, "has no partner in " + first_folder.string() + " (" + counts + ")",
                      "restore the partner or remove the file");
  }
  std::vector<DriveFrame> frames;
  for (const path& file : first) {
    const auto partner = second.find(key_of(file));
    if (partner == second.end()) {
      throw input_error(file, "has no partner in " + second_folder.string() + " (" + counts + ")",
                        "restore the partner or remove the file");
    }
    frames.push_back({static_cast<int>(frames.size()), {}, {file, partner->second}});
  }
  return frames;
}

void take_times(const path& file, Drive& drive) {
  if (!is_file(file)) {
    constexpr std::int64_t kTenthNs = 100'000'000;
    for (DriveFrame& frame : drive.frames) frame.stamp.nanoseconds = frame.number * kTenthNs;
    drive.notes.push_back(file.string() + " is not there: 10 frames a second are assumed");
    return;
  }
  std::vector<Stamp> stamps;
  for_each_line(file, read_file(file), [&](const std::string& where, const auto& words) {
    // "+0.1" and the like, which parse_stamp() does not take.
    const auto stamp = parse_stamp(words[0].starts_with('+') ? words[0].substr(1) : words[0]);
    if (!stamp) {
      const double seconds = number_in_file(words[0], "the time", where);
      throw Error(ErrorKind::kInput, fmt::format("the time {:g} s is of another age", seconds),
                  where, "correct the line");
    }
    stamps.push_back(*stamp);
    const std::size_t count = stamps.size();
    if (count > 1 && stamps[count - 1] <= stamps[count - 2]) {
      throw Error(ErrorKind::kInput,
                  fmt::format("time {} does not follow {}", words[0], to_string(stamps[count - 2])),
                  where, "times must increase: correct the line");
    }
  });
  if (stamps.size() != drive.frames.size()) {
    throw input_error(file,
                      fmt::format("{} times for {} frames", stamps.size(), drive.frames.size()),
                      "give one a frame");
  }
  for (DriveFrame& frame : drive.frames) {
    frame.stamp = stamps[static_cast<std::size_t>(frame.number)];
  }
  drive.inputs.push_back(file);
  check_increase(file, drive);
}

std::vector<Stamp> read_datetimes(const path& file) {
  std::vector<Stamp> stamps;
  for_each_line(file, read_file(file), [&](const std::string& where, const auto& words) {
    std::tm date{};
    const std::string day(words[0]);
    const std::string time(words.size() > 1 ? words[1] : "");
    const std::size_t dot = std::min(time.find('.'), time.size());
    const auto fraction = parse_stamp("0" + time.substr(dot));
    const char* end_of_day = strptime(day.c_str(), "%Y-%m-%d", &date);
    const std::string clock = time.substr(0, dot);
    const char* end_of_time = strptime(clock.c_str(), "%H:%M:%S", &date);
    if (end_of_day == nullptr || end_of_time == nullptr || !fraction) {
      throw Error(ErrorKind::kInput, "is not a date and time", where,
                  "a line is 2011-09-26 13:02:25.964389445");
    }
    const auto seconds = parse_stamp(std::to_string(timegm(&date)));
    if (!seconds) {
      throw Error(ErrorKind::kInput, "is a date of another age", where, "correct the line");
    }
    stamps.push_back({seconds->nanoseconds + fraction->nanoseconds});
  });
  return stamps;
}

Transform3<frames::Robot, frames::Camera> default_robot_from_camera() {
  return {forward_camera_rotation(), Eigen::Vector3d::Zero()};
}

void check_pair(const StereoFrame& frame, const StereoRig& rig, const std::string& left,
                const std::string& right) {
  if (!frame.left.same_size(frame.right) || frame.left.channels() != frame.right.channels()) {
    throw Error(
        ErrorKind::kInput,
        fmt::format("is {} pixels with {} channels, {} is {} with {}", size_of(frame.left),
                    frame.left.channels(), right, size_of(frame.right), frame.right.channels()),
        left, "give pairs of one size and kind");
  }
  if (frame.left.width() != rig.left.width || frame.left.height() != rig.left.height) {
    throw Error(ErrorKind::kInput,
                fmt::format("is {} pixels, the calibration or the first frame is {} x {}",
                            size_of(frame.left), rig.left.width, rig.left.height),
                left, "give the calibration of these images");
  }
}

void read_stereo_from_files(Drive& drive) {
  drive.read_stereo = [rig = std::get<StereoRig>(drive.rig)](const DriveFrame& frame) {
    StereoFrame stereo{frame.stamp, read_image(frame.files[0]), read_image(frame.files[1])};
    check_pair(stereo, rig, frame.files[0].string(), frame.files[1].string());
    return stereo;
  };
}

void read_lidar_from_files(Drive& drive) {
  drive.read_lidar = [rig = std::get<LidarRig>(drive.rig)](const DriveFrame& frame,
                                                           std::vector<std::string>& notes) {
    PointCloud cloud = read_point_cloud(frame.files[0]);
    if (cloud.leftover_bytes > 0) {
      notes.push_back(fmt::format("{}: {} bytes after the last whole point: the file is cut off",
                                  frame.files[0].string(), cloud.leftover_bytes));
    }
    if (2 * cloud.invalid > cloud.points.size()) {
      notes.push_back(fmt::format("{}: {} points are NaN, infinite or zero, {} are left",
                                  frame.files[0].string(), cloud.invalid, cloud.points.size()));
    }
    LidarFrame lidar{frame.stamp, std::move(cloud.points), {}};
    for (std::size_t i = 1; i < frame.files.size(); ++i) {
      lidar.images.push_back(read_image(frame.files[i]));
      const CameraModel& model = rig.cameras[i - 1].model;
      const auto& image = lidar.images.back();
      if (image.width() == model.width && image.height() == model.height) continue;
      throw input_error(frame.files[i],
                        fmt::format("is {} pixels, the calibration or the first frame is {} x {}",
                                    size_of(image), model.width, model.height),
                        "give the calibration of these images");
    }
    return lidar;
  };
}

void take_image_sizes(Drive& drive) {
  const auto& files = drive.frames.front().files;
  const auto take = [](CameraModel& model, const path& file) {
    if (model.width > 0) return;
    const Raster<std::uint8_t> image = read_image(file);
    model.width = image.width();
    model.height = image.height();
  };
  if (auto* stereo = std::get_if<StereoRig>(&drive.rig)) {
    take(stereo->left, files[0]);
    stereo->right.width = stereo->left.width;
    stereo->right.height = stereo->left.height;
    return;
  }
  auto& cameras = std::get<LidarRig>(drive.rig).cameras;
  for (std::size_t i = 0; i < cameras.size(); ++i) take(cameras[i].model, files[i + 1]);
}

void check_rig(const StereoRig& rig, const std::string& where) {
  if (!(rig.left.fx > 0.0) || !(rig.left.fy > 0.0) || !(rig.right.fx > 0.0) ||
      !(rig.right.fy > 0.0)) {
    throw Error(ErrorKind::kInput,
                fmt::format("the focal length is {:.6g} (left) and {:.6g} (right) pixels",
                            rig.left.fx, rig.right.fx),
                where, "correct the calibration");
  }
  if (!is_finite(rig.left) || !is_finite(rig.right) || !rig.right_from_left.is_finite()) {
    throw Error(ErrorKind::kInput, "the calibration holds or leads to numbers that are not finite",
                where, "correct the calibration");
  }
  constexpr double kSmallestM = 1e-4;
  if (!(rig.baseline_m() > kSmallestM)) {
    throw Error(ErrorKind::kInput,
                "the calibration has no baseline: left and right camera stand in one place", where,
                "the right row needs -f * baseline as its 4th number");
  }
  // x of the left camera in the right camera's frame: the right camera stands to the right.
  if (rig.right_from_left.translation.x() > 0.0) {
    throw Error(ErrorKind::kInput,
                fmt::format("the baseline is {:.4g} m, below 0: the right camera stands left of "
                            "the left one",
                            -rig.right_from_left.translation.x()),
                where, "swap left and right");
  }
}

}  // namespace nadir
