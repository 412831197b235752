// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <charconv>
#include <map>

#include "nadir/io/drives/detail/camera_yaml.hpp"
#include "nadir/io/drives/detail/drive_layout.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using std::filesystem::path;

/// data.csv of a camera: stamp in ns -> image.
std::map<std::int64_t, path> images_of(const path& camera) {
  const path list = camera / "data.csv";
  std::string text = read_file(list);
  std::replace(text.begin(), text.end(), ',', ' ');
  std::map<std::int64_t, path> images;
  for_each_line(list, text, [&](const std::string& where, const auto& words) {
    std::int64_t stamp = 0;
    const auto [end, error] =
        std::from_chars(words[0].data(), words[0].data() + words[0].size(), stamp);
    if (error != std::errc{} || end != words[0].data() + words[0].size() || words.size() < 2 ||
        !is_near_epoch({stamp})) {
      throw Error(ErrorKind::kInput, fmt::format("'{}' is not whole nanoseconds", words[0]), where,
                  "a line is `stamp,file`");
    }
    if (!images.empty() && stamp <= images.rbegin()->first) {
      throw Error(ErrorKind::kInput,
                  fmt::format("time {} does not follow {}", stamp, images.rbegin()->first), where,
                  "times must increase: correct the line");
    }
    const path image = camera / "data" / std::string(words[1]);
    if (!is_file(image)) {
      throw Error(ErrorKind::kInput, "names " + image.string() + ", which is not there", where,
                  "restore the image or remove the line");
    }
    images.emplace_hint(images.end(), stamp, image);
  });
  if (images.empty()) throw input_error(list, "lists no image", "give EuRoC's data.csv");
  return images;
}

std::vector<DriveFrame> frames_of(const path& folder, std::vector<std::string>& notes) {
  const auto left = images_of(folder / "cam0");
  const auto right = images_of(folder / "cam1");
  std::vector<DriveFrame> frames;
  for (const auto& [stamp, image] : left) {
    const auto partner = right.find(stamp);
    if (partner == right.end()) continue;
    frames.push_back({static_cast<int>(frames.size()), {stamp}, {image, partner->second}});
  }
  if (frames.empty()) {
    throw input_error(folder, "cam0 and cam1 have no stamp in common", "give one recording");
  }
  if (const std::size_t alone = left.size() + right.size() - 2 * frames.size(); alone > 0) {
    notes.push_back(
        fmt::format("{}: {} images have no partner and are left out", folder.string(), alone));
  }
  return frames;
}

}  // namespace

OpenedLayout open_euroc(const path& given, const Mounting& mounting) {
  const path folder = is_folder(given / "mav0") ? given / "mav0" : given;
  const EurocCamera left = read_euroc_camera(folder / "cam0" / "sensor.yaml");
  const EurocCamera right = read_euroc_camera(folder / "cam1" / "sensor.yaml");
  StereoRig rig;
  rig.left = left.model;
  rig.right = right.model;
  const auto right_from_left = right.body_from_camera.inverse() * left.body_from_camera;
  rig.right_from_left = {right_from_left.rotation, right_from_left.translation};
  rig.robot_from_left = mounting.robot_from_camera.value_or(default_robot_from_camera());
  check_rig(rig, (folder / "cam1" / "sensor.yaml").string());
  OpenedLayout layout;
  layout.robot_from_pose_camera = rig.robot_from_left;
  layout.robot_from_body = rig.robot_from_left * left.body_from_camera.inverse();
  layout.drive.frames = frames_of(folder, layout.drive.notes);
  layout.drive.inputs = {folder / "cam0" / "sensor.yaml", folder / "cam1" / "sensor.yaml"};
  layout.drive.rig = std::move(rig);
  const path truth = folder / "state_groundtruth_estimate0" / "data.csv";
  if (is_file(truth)) layout.poses = truth;
  return layout;
}

OpenedLayout open_stereo_folder(const path& folder, const Mounting& mounting) {
  const auto folders = find_stereo_folders(folder);
  if (!folders) {
    throw input_error(folder, "holds no pair of image folders",
                      "left and right, image_l and image_r, image_0 and image_1 are looked for");
  }
  std::vector<path> opencv;
  path kalibr;
  for (const path& file : files_in(folder, Depth::kFolder)) {
    const std::string extension = file.extension().string();
    if (extension != ".yaml" && extension != ".yml") continue;
    if (file.filename() == kMountingFile) continue;
    if (is_opencv_yaml(file)) {
      opencv.push_back(file);
    } else {
      kalibr = file;
    }
  }
  if (opencv.empty() && kalibr.empty()) {
    throw input_error(folder, "holds no calibration",
                      "add OpenCV's stereo YAML or Kalibr's camchain YAML");
  }
  OpenedLayout layout;
  StereoRig rig = opencv.empty() ? read_kalibr_rig(kalibr) : read_opencv_rig(opencv);
  rig.robot_from_left = mounting.robot_from_camera.value_or(default_robot_from_camera());
  layout.robot_from_pose_camera = rig.robot_from_left;
  layout.drive.rig = std::move(rig);
  layout.drive.inputs = opencv.empty() ? std::vector<path>{kalibr} : opencv;
  layout.drive.frames =
      paired(folders->left, DriveFiles::kImages, folders->right, DriveFiles::kImages);
  take_times(folder / "times.txt", layout.drive);
  for (const char* name : {"poses.txt", "odometry.tum"}) {
    if (is_file(folder / name)) layout.poses = folder / name;
  }
  return layout;
}

}  // namespace nadir
