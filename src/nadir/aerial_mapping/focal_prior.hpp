// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "nadir/core/photo.hpp"

namespace nadir {

/// What is known of a focal length before the adjustment.
struct FocalPrior {
  double focal_px = 0.0;        ///< pixels at the working size; 0 = unknown
  double relative_sigma = 0.3;  ///< standard deviation of ln f
  std::string source;           ///< in words, for reports
};

/// The sensor of a camera, as wide as its photos.
struct SensorEntry {
  std::string_view make;
  std::string_view model;
  double width_mm;
  double focal_mm;  ///< of its fixed lens; 0 = interchangeable or zoom
};

/// Cameras of drones whose sensor is known.
const std::vector<SensorEntry>& sensor_table();

/// The sensor of a camera; nothing where the table does not know it. Case does not matter.
std::optional<SensorEntry> find_sensor(std::string_view make, std::string_view model);

/// The focal length of a photo `working_width` pixels wide, from the best source that its tags
/// offer: sensor table and focal length, focal-plane resolution, 35 mm equivalent. The image size
/// that EXIF claims is not believed: resized photos keep it. `warnings` takes what the user should
/// know (two sources more than 5 % apart, nothing known).
FocalPrior focal_prior(const PhotoMetadata& metadata, int working_width,
                       std::vector<std::string>* warnings = nullptr);

}  // namespace nadir
