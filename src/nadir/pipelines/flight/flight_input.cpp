// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/flight_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/photo_file.hpp"
#include "nadir/io/provenance/sha256.hpp"
#include "nadir/pipelines/flight/flight_control.hpp"
#include "nadir/pipelines/flight/flight_poses.hpp"
#include "nadir/pipelines/flight/photo_pixels.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;

constexpr double kFewest = 0.6;  // of the photos that must be readable
/// An altitude that is not known, with a weight that says so.
constexpr double kUnknownAltitudeSigma = 1000.0;

/// File names where they are unique, else the path below the folder.
std::vector<std::string> names_of(const std::vector<fs::path>& files, const fs::path& folder) {
  std::set<fs::path> names;
  for (const fs::path& file : files) names.insert(file.filename());
  const bool unique = names.size() == files.size();
  std::vector<std::string> result;
  for (const fs::path& file : files) {
    result.push_back(unique ? file.filename().string() : fs::relative(file, folder).string());
  }
  return result;
}

/// Reads the whole file once: cut-off photos and copies show before the work begins.
FlightPhoto read_one(const fs::path& file, const std::string& name,
                     std::map<std::string, std::string>& known, std::vector<std::string>& copies) {
  FlightPhoto photo{file, read_photo_metadata(file)};
  photo.metadata.name = name;
  photo.digest = sha256_of_file(file);
  const std::string bytes = read_file(file);
  check_image_is_whole(file, bytes);
  const auto [first, added] = known.try_emplace(photo.digest, name);
  if (!added) copies.push_back(name + " (as " + first->second + ")");
  if (!added) photo.file.clear();
  return photo;
}

std::vector<FlightPhoto> read_photos(const fs::path& folder, FlightInput& input,
                                     const std::function<void(int, int)>& progress) {
  const std::vector<fs::path> files = photo_files(folder);
  const std::vector<std::string> names = names_of(files, folder);
  std::vector<FlightPhoto> photos;
  std::vector<std::string> unreadable;
  std::vector<std::string> copies;
  std::map<std::string, std::string> known;
  input.found = static_cast<int>(files.size());
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      FlightPhoto photo = read_one(files[i], names[i], known, copies);
      if (!photo.file.empty()) photos.push_back(std::move(photo));
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::kInput) throw;
      unreadable.push_back(names[i]);
      input.warnings.push_back(fmt::format("{}; skipped", error.what()));
    }
    if (progress) progress(static_cast<int>(i) + 1, input.found);
  }
  if (!copies.empty()) {
    input.warnings.push_back(listed(copies) + ": the same photo twice; left out");
  }
  const auto readable = static_cast<double>(files.size() - unreadable.size());
  if (readable < kFewest * static_cast<double>(files.size())) {
    throw Error(ErrorKind::kInput,
                fmt::format("{} of {} photos cannot be read: {}", unreadable.size(), files.size(),
                            listed(unreadable)),
                folder.string(), "copy them again from the drone");
  }
  return photos;
}

std::optional<MetricFrame> frame_of(const std::vector<FlightPhoto>& photos,
                                    const std::vector<ListedControlPoint>& points) {
  std::vector<GeodeticPosition> places;
  for (const FlightPhoto& photo : photos) {
    if (photo.metadata.position) places.push_back(*photo.metadata.position);
  }
  if (places.empty()) {
    for (const ListedControlPoint& point : points) places.push_back(point.position);
  }
  if (places.empty()) return std::nullopt;
  return MetricFrame::around(places);
}

void require_scale(const FlightInput& input, const FlightFiles& files) {
  const bool height = std::ranges::any_of(input.photos, [](const PhotoMetadata& photo) {
    return photo.relative_altitude_m.has_value();
  });
  if (input.frame || height || files.metres_per_pixel > 0.0 || !files.poses.empty()) return;
  throw Error(ErrorKind::kUsage, "no positions: the map will have no scale", files.photos.string(),
              "give --metres-per-pixel, --gcp or --positions with a CSV of "
              "name,lat,lon,alt");
}

void add_photos(std::vector<FlightPhoto> photos, const AerialMappingOptions& options,
                FlightInput& input) {
  std::vector<PhotoMetadata> metadata;
  for (FlightPhoto& photo : photos) metadata.push_back(std::move(photo.metadata));
  const FlightCheck check = check_flight(metadata);
  input.warnings.insert(input.warnings.end(), check.warnings.begin(), check.warnings.end());
  for (const std::size_t i : check.used) input.photos.push_back(metadata[i]);
  FlightCameras cameras = cameras_of(input.photos, options.max_image_px);
  input.warnings.insert(input.warnings.end(), cameras.warnings.begin(), cameras.warnings.end());
  input.set.cameras = std::move(cameras.cameras);
  const PhotoPixels pixels(options.max_image_px);
  const MetricFrame* frame = input.frame ? &*input.frame : nullptr;
  for (std::size_t i = 0; i < check.used.size(); ++i) {
    MappingPhoto photo;
    photo.name = input.photos[i].name;
    photo.camera = cameras.camera_of[i];
    photo.prior = prior_of(input.photos[i], frame);
    photo.load = pixels.loader(photos[check.used[i]].file);
    photo.digest = fmt::format("{}/{}", photos[check.used[i]].digest, options.max_image_px);
    input.files.push_back(photos[check.used[i]].file);
    input.set.photos.push_back(std::move(photo));
  }
  input.estimate = estimate_flight(input.photos);
}

/// Metres per pixel of the photos as stored -> of the photos at their working size.
std::optional<double> working_pixel(const FlightFiles& files, const FlightInput& input) {
  if (!(files.metres_per_pixel > 0.0) || input.photos.empty()) return std::nullopt;
  const CameraPrior& camera = input.set.cameras[input.set.photos.front().camera];
  return files.metres_per_pixel * input.photos.front().width / camera.width;
}

}  // namespace

std::vector<std::string> apply_positions(const std::vector<ListedPosition>& list,
                                         std::vector<FlightPhoto>& photos) {
  std::vector<std::string> unknown;
  for (const ListedPosition& listed_position : list) {
    const auto photo = std::ranges::find_if(photos, [&](const FlightPhoto& candidate) {
      return candidate.metadata.name == listed_position.photo ||
             candidate.file.stem() == listed_position.photo;
    });
    if (photo == photos.end()) {
      unknown.push_back(listed_position.photo);
      continue;
    }
    photo->metadata.position = listed_position.position;
    if (listed_position.attitude) photo->metadata.gimbal = listed_position.attitude;
  }
  return unknown;
}

PhotoPrior prior_of(const PhotoMetadata& photo, const MetricFrame* frame) {
  PhotoPrior prior;
  if (photo.position && frame != nullptr) {
    prior.position = frame->to_map(*photo.position);
    prior.horizontal_sigma_m = photo.position->horizontal_sigma_m;
    prior.vertical_sigma_m = photo.position->altitude_known ? photo.position->vertical_sigma_m
                                                            : std::optional(kUnknownAltitudeSigma);
  }
  if (photo.gimbal) {
    const double heading = radians(photo.gimbal->yaw_deg);
    const double yaw = photo.position && frame != nullptr
                           ? frame->yaw_of_true_heading(heading, *photo.position)
                           : yaw_of_heading(heading);
    prior.attitude =
        PhotoAttitude{yaw, radians(photo.gimbal->pitch_deg), radians(photo.gimbal->roll_deg)};
  }
  prior.relative_altitude_m = photo.relative_altitude_m;
  prior.taken_at = photo.taken_at;
  if (photo.exposure_s && photo.iso && photo.f_number) {
    prior.exposure = *photo.exposure_s * *photo.iso / (*photo.f_number * *photo.f_number);
  }
  return prior;
}

FlightInput read_flight(const FlightFiles& files, const AerialMappingOptions& options,
                        const std::function<void(int, int)>& progress) {
  FlightInput input;
  std::vector<FlightPhoto> photos = read_photos(files.photos, input, progress);
  if (!files.positions.empty()) {
    const std::vector<ListedPosition> list = read_positions(files.positions);
    const auto unknown = apply_positions(list, photos);
    if (!unknown.empty()) {
      input.warnings.push_back(listed(unknown) + ": in " + files.positions.string() +
                               ", but not among the photos");
    }
    if (unknown.size() == list.size()) {
      input.doubts.push_back(files.positions.string() +
                             ": none of its names is that of a photo: its positions have no part "
                             "in the map; give the photos' names");
    }
  }
  std::vector<ListedControlPoint> points;
  if (!files.control_points.empty()) points = read_control_points(files.control_points);
  input.frame = frame_of(photos, points);
  if (input.frame) input.set.crs = input.frame->crs();
  add_photos(std::move(photos), options, input);
  require_scale(input, files);
  if (!files.poses.empty()) add_poses(files.poses, input);
  if (!points.empty()) {
    add_control_points(points, files.control_points, input);
  }
  input.set.metres_per_photo_pixel = working_pixel(files, input);
  return input;
}

}  // namespace nadir
