// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/flight_poses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "nadir/aerial_mapping/pose_alignment.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

/// Names in pose files may lack the folder or the extension.
std::string matching_photo(const std::string& name, const FlightInput& input) {
  const std::filesystem::path wanted(name);
  for (const MappingPhoto& photo : input.set.photos) {
    const std::filesystem::path own(photo.name);
    if (photo.name == name || own.filename() == wanted.filename() || own.stem() == wanted) {
      return photo.name;
    }
  }
  return {};
}

void place(ImportedPoses& imported, const std::string& origin, FlightInput& input) {
  if (imported.frame == PhotoPoseFrame::kModel) {
    const double residual = align_poses(imported.poses, input.set.photos);
    input.warnings.push_back(fmt::format(
        "{}: in a frame of its own; fitted to the photos' positions, {:.2f} m root mean square",
        origin, residual));
  } else if (imported.frame == PhotoPoseFrame::kMap) {
    // Where tags and poses disagree on the frame, the poses lie where the map will be.
    input.set.crs = imported.crs;
  } else if (!input.frame) {
    const GeodeticPosition place_of_poses =
        imported.frame == PhotoPoseFrame::kTopocentric
            ? imported.reference
            : from_geocentric(imported.poses.front().map_from_camera.translation);
    input.frame = MetricFrame::around({place_of_poses});
    input.set.crs = input.frame->crs();
  }
  if (imported.frame != PhotoPoseFrame::kModel && imported.frame != PhotoPoseFrame::kMap) {
    imported.poses = in_map_frame(imported, *input.frame);
  }
}

}  // namespace

void add_poses(const std::filesystem::path& file, FlightInput& input) {
  add_poses(read_photo_poses(file), file.string(), input);
}

void add_poses(ImportedPoses imported, const std::string& origin, FlightInput& input) {
  input.warnings.insert(input.warnings.end(), imported.warnings.begin(), imported.warnings.end());
  for (PhotoPose& pose : imported.poses) pose.name = matching_photo(pose.name, input);
  std::erase_if(imported.poses, [](const PhotoPose& pose) { return pose.name.empty(); });
  if (imported.poses.empty()) {
    throw Error(ErrorKind::kUsage, "none of its poses is that of a photo", origin,
                "the names must be those of the photos");
  }
  place(imported, origin, input);
  std::vector<std::string> without;
  for (MappingPhoto& photo : input.set.photos) {
    const auto pose = std::ranges::find(imported.poses, photo.name, &PhotoPose::name);
    if (pose == imported.poses.end()) {
      without.push_back(photo.name);
      continue;
    }
    const CameraPrior& camera = input.set.cameras[photo.camera];
    photo.pose = PhotoPose{photo.name, resized(pose->camera, camera.width, camera.height),
                           pose->map_from_camera};
  }
  if (without.empty()) return;
  input.warnings.push_back(listed(without) + ": no pose in " + origin + "; left out");
  for (std::size_t i = input.set.photos.size(); i-- > 0;) {
    if (input.set.photos[i].pose) continue;
    input.set.photos.erase(input.set.photos.begin() + static_cast<std::ptrdiff_t>(i));
    input.photos.erase(input.photos.begin() + static_cast<std::ptrdiff_t>(i));
    input.files.erase(input.files.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

}  // namespace nadir
