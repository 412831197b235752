// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/photo.hpp"

namespace nadir {

/// Which photos of a flight take part, and what its user should know of their tags.
struct FlightCheck {
  std::vector<std::size_t> used;      ///< indices of the photos that take part, in order
  std::vector<std::string> left_out;  ///< names of the others
  std::vector<std::string> warnings;
};

/// Steeper than this (degrees below the horizon) a photo counts as looking down.
inline constexpr double kObliquePitchDeg = -60.0;

/// Looks through the tags of the photos. Positions that cannot be believed are taken back: the same
/// place written to several photos, and a place farther from every other photo than 20 times the
/// usual distance. Photos that look to the side (gimbal pitch above -60 degrees) are left out where
/// others look down. Every finding names its photos.
FlightCheck check_flight(std::vector<PhotoMetadata>& photos);

/// The cameras of a flight: photos of one make, model, serial number, size and focal length share
/// their intrinsics.
struct FlightCameras {
  std::vector<CameraPrior> cameras;
  std::vector<std::size_t> camera_of;  ///< of each photo
  std::vector<std::string> warnings;
};

/// `working_width` gives the width at which a photo is worked with, and so its camera's pixels.
/// Throws Error (usage) where one camera, which the sensor table does not know, has photos of
/// different proportions: some are cropped, and nothing says which.
FlightCameras cameras_of(const std::vector<PhotoMetadata>& photos, int max_image_px);

/// What can be said of a map before its photos are looked at; 0 = nothing.
struct FlightEstimate {
  double photo_pixel_m = 0.0;  ///< of the photos as stored, at the median height above take-off
  double width_m = 0.0;        ///< of the ground that the photos cover
  double height_m = 0.0;
};
FlightEstimate estimate_flight(const std::vector<PhotoMetadata>& photos);

/// "a.jpg, b.jpg and 7 more".
std::string listed(const std::vector<std::string>& names);

}  // namespace nadir
