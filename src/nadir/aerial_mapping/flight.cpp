// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "nadir/aerial_mapping/detail/median.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"

namespace nadir {
namespace {

using Names = std::vector<std::string>;

constexpr double kMetresPerDegree = 111320.0;  // of latitude; good enough for neighbourhoods
constexpr double kJump = 20.0;                 // times the usual distance to the next photo

double distance_m(const GeodeticPosition& a, const GeodeticPosition& b) {
  const double east = std::remainder(b.longitude_deg - a.longitude_deg, 360.0) *
                      std::cos(radians(0.5 * (a.latitude_deg + b.latitude_deg)));
  return kMetresPerDegree * std::hypot(east, b.latitude_deg - a.latitude_deg);
}

void warn(Names& warnings, const Names& names, const std::string& what) {
  if (!names.empty()) warnings.push_back(listed(names) + ": " + what);
}

/// A receiver that has lost its fix repeats its last one: only the first photo of a place keeps it.
void take_back_repeated(std::vector<PhotoMetadata>& photos, Names& warnings) {
  std::set<std::tuple<double, double, double>> seen;
  Names repeated;
  for (PhotoMetadata& photo : photos) {
    if (!photo.position) continue;
    const auto& p = *photo.position;
    if (seen.emplace(p.latitude_deg, p.longitude_deg, p.altitude_m).second) continue;
    repeated.push_back(photo.name);
    photo.position.reset();
  }
  warn(warnings, repeated, "the very position of another photo; taken as unknown");
}

void take_back_jumps(std::vector<PhotoMetadata>& photos, Names& warnings) {
  std::vector<double> nearest(photos.size(), std::numeric_limits<double>::infinity());
  std::vector<double> usual;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    for (std::size_t k = 0; k < photos.size() && photos[i].position; ++k) {
      if (k == i || !photos[k].position) continue;
      nearest[i] = std::min(nearest[i], distance_m(*photos[i].position, *photos[k].position));
    }
    if (std::isfinite(nearest[i])) usual.push_back(nearest[i]);
  }
  constexpr std::size_t kEnough = 4;
  if (usual.size() < kEnough) return;
  const double limit = kJump * std::max(aerial::median_of(usual), 1.0);
  Names far;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    if (!photos[i].position || nearest[i] <= limit) continue;
    far.push_back(photos[i].name);
    photos[i].position.reset();
  }
  warn(warnings, far,
       "more than " + std::to_string(std::lround(limit)) +
           " m from every other photo; the position is taken as unknown");
}

void tell_missing(const std::vector<PhotoMetadata>& photos, Names& warnings) {
  Names without;
  Names flat;
  Names turned;
  for (const PhotoMetadata& photo : photos) {
    if (!photo.position) without.push_back(photo.name);
    if (photo.position && !photo.position->altitude_known) flat.push_back(photo.name);
    if (photo.orientation != 1) turned.push_back(photo.name);
  }
  if (without.size() < photos.size()) {
    warn(warnings, without, "no position; placed by what the photos show");
  }
  warn(warnings, flat, "no altitude; the height is found from the others");
  warn(warnings, turned, "an EXIF orientation tag; the pixels are taken as stored");
}

void tell_groups(const std::vector<PhotoMetadata>& photos, Names& warnings) {
  std::set<std::string> serials;
  std::set<std::int64_t> days;
  for (const PhotoMetadata& photo : photos) {
    constexpr std::int64_t kDay = 86'400'000'000'000;
    serials.insert(photo.make + " " + photo.model + " " + photo.serial);
    if (photo.taken_at) days.insert(photo.taken_at->nanoseconds / kDay);
  }
  if (serials.size() > 1) {
    warnings.push_back("photos of " + std::to_string(serials.size()) +
                       " cameras: each has its own intrinsics, and its own clock");
  }
  if (days.size() > 1) {
    warnings.push_back("photos of " + std::to_string(days.size()) +
                       " days: light and parked cars differ between them");
  }
}

bool is_oblique(const PhotoMetadata& photo) {
  return photo.gimbal && photo.gimbal->pitch_deg > kObliquePitchDeg;
}

double aspect(const PhotoMetadata& photo) {
  return static_cast<double>(std::max(photo.width, photo.height)) /
         std::max(1, std::min(photo.width, photo.height));
}

/// Photos of one camera that differ in proportions were cropped, and their principal point and
/// focal length are anybody's guess. A camera of the table is known well enough to go on.
void check_proportions(const std::vector<PhotoMetadata>& photos) {
  constexpr double kSameAspect = 0.01;
  std::map<std::string, const PhotoMetadata*> first;
  for (const PhotoMetadata& photo : photos) {
    if (find_sensor(photo.make, photo.model)) continue;
    const auto [known, added] =
        first.try_emplace(photo.make + "|" + photo.model + "|" + photo.serial, &photo);
    if (added || std::abs(aspect(photo) / aspect(*known->second) - 1.0) < kSameAspect) continue;
    const auto size = [](const PhotoMetadata& p) {
      return p.name + " is " + std::to_string(p.width) + " x " + std::to_string(p.height);
    };
    throw Error(ErrorKind::kUsage,
                size(*known->second) + " px and " + size(photo) +
                    ", of the same camera: some photos are cropped",
                {}, "give photos of one size, or the originals");
  }
}

std::string camera_name(const PhotoMetadata& photo) {
  std::string name = photo.make + " " + photo.model;
  if (!photo.serial.empty()) name += " " + photo.serial;
  name += " " + std::to_string(photo.width) + " x " + std::to_string(photo.height);
  if (photo.focal_length_mm) {
    std::string focal = std::to_string(*photo.focal_length_mm);
    focal.erase(focal.find_last_not_of('0') + 1);
    if (focal.ends_with('.')) focal.pop_back();
    name += " " + focal + " mm";
  }
  name.erase(0, name.find_first_not_of(' '));
  return name;
}

int working_size(int side, int longer, int max_image_px) {
  if (longer <= max_image_px) return side;
  return std::max(1,
                  static_cast<int>(std::lround(static_cast<double>(side) * max_image_px / longer)));
}

}  // namespace

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kShown = 12;
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i) {
    text += (i == 0 ? "" : ", ") + names[i];
  }
  if (names.size() > kShown) text += " and " + std::to_string(names.size() - kShown) + " more";
  return text;
}

FlightCheck check_flight(std::vector<PhotoMetadata>& photos) {
  FlightCheck check;
  take_back_repeated(photos, check.warnings);
  take_back_jumps(photos, check.warnings);
  const auto oblique = std::count_if(photos.begin(), photos.end(), is_oblique);
  const bool leave_out = 2 * oblique <= std::ssize(photos);
  for (std::size_t i = 0; i < photos.size(); ++i) {
    if (leave_out && is_oblique(photos[i])) {
      check.left_out.push_back(photos[i].name);
    } else {
      check.used.push_back(i);
    }
  }
  warn(check.warnings, check.left_out, "look to the side (gimbal above -60 degrees); left out");
  if (!leave_out) {
    check.warnings.push_back(std::to_string(oblique) + " of " + std::to_string(photos.size()) +
                             " photos look to the side (gimbal above -60 degrees): the map will be "
                             "coarse and torn at everything that stands up");
  }
  tell_missing(photos, check.warnings);
  tell_groups(photos, check.warnings);
  return check;
}

FlightCameras cameras_of(const std::vector<PhotoMetadata>& photos, int max_image_px) {
  check_proportions(photos);
  FlightCameras result;
  std::map<std::string, std::size_t> known;
  for (const PhotoMetadata& photo : photos) {
    const auto [found, added] = known.try_emplace(camera_name(photo), result.cameras.size());
    result.camera_of.push_back(found->second);
    if (!added) continue;
    const int longer = std::max(photo.width, photo.height);
    CameraPrior camera;
    camera.name = found->first;
    camera.width = working_size(photo.width, longer, max_image_px);
    camera.height = working_size(photo.height, longer, max_image_px);
    camera.focal = focal_prior(photo, camera.width, &result.warnings);
    if (photo.exif_width && *photo.exif_width != photo.width && *photo.exif_width != photo.height) {
      result.warnings.push_back(photo.name + ": EXIF says " + std::to_string(*photo.exif_width) +
                                " px, the photo is " + std::to_string(photo.width) +
                                " px wide: resized, and the focal length in proportion");
    }
    result.cameras.push_back(std::move(camera));
  }
  return result;
}

FlightEstimate estimate_flight(const std::vector<PhotoMetadata>& photos) {
  FlightEstimate estimate;
  std::vector<double> heights;
  std::vector<double> pixels;
  double footprint = 0.0;
  for (const PhotoMetadata& photo : photos) {
    if (!photo.relative_altitude_m || *photo.relative_altitude_m <= 0.0) continue;
    const double focal = focal_prior(photo, photo.width).focal_px;
    pixels.push_back(*photo.relative_altitude_m / focal);
    footprint = std::max(footprint, pixels.back() * std::max(photo.width, photo.height));
  }
  estimate.photo_pixel_m = aerial::median_of(pixels);
  std::vector<GeodeticPosition> places;
  for (const PhotoMetadata& photo : photos) {
    if (photo.position) places.push_back(*photo.position);
  }
  if (places.empty()) return estimate;
  const auto [south, north] = std::minmax_element(
      places.begin(), places.end(),
      [](const auto& a, const auto& b) { return a.latitude_deg < b.latitude_deg; });
  const auto [west, east] = std::minmax_element(
      places.begin(), places.end(),
      [](const auto& a, const auto& b) { return a.longitude_deg < b.longitude_deg; });
  GeodeticPosition corner = *south;
  corner.longitude_deg = west->longitude_deg;
  GeodeticPosition other = corner;
  other.longitude_deg = east->longitude_deg;
  estimate.width_m = distance_m(corner, other) + footprint;
  other = corner;
  other.latitude_deg = north->latitude_deg;
  estimate.height_m = distance_m(corner, other) + footprint;
  return estimate;
}

}  // namespace nadir
