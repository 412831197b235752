// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "nadir/core/camera.hpp"
#include "nadir/core/frames3.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/stamp.hpp"

namespace nadir {

/// Where a photo was taken, as its tags or a list of positions say it.
struct GeodeticPosition {
  double latitude_deg = 0.0;   ///< WGS84, north positive
  double longitude_deg = 0.0;  ///< WGS84, east positive
  double altitude_m = 0.0;
  bool ellipsoidal = false;  ///< altitude above the ellipsoid; else above mean sea level
  /// Standard deviations, where they are given (RTK, a list).
  std::optional<double> horizontal_sigma_m = std::nullopt;
  std::optional<double> vertical_sigma_m = std::nullopt;
  bool altitude_known = true;  ///< false: altitude_m means nothing
};

/// Attitude of the gimbal as DJI and most others write it: degrees, yaw clockwise from north, pitch
/// -90 = straight down, roll 0 = level.
struct GimbalAttitude {
  double yaw_deg = 0.0;
  double pitch_deg = 0.0;
  double roll_deg = 0.0;
};

/// What the tags of a drone photo say. Absent = not there or not to be believed (0, 0 is no
/// position).
struct PhotoMetadata {
  std::string name;  ///< file name without folder: the photo's identity in lists and reports
  int width = 0;     ///< pixels as stored; EXIF orientation is not applied
  int height = 0;
  int orientation = 1;            ///< EXIF orientation tag
  std::optional<int> exif_width;  ///< pixels that EXIF claims; differs after any resize
  std::optional<int> exif_height;
  std::string make;
  std::string model;
  std::string serial;
  std::optional<Stamp> taken_at;  ///< local time of the camera, since 1970, with its sub-seconds
  std::optional<GeodeticPosition> position;
  std::optional<double> relative_altitude_m;  ///< above the take-off
  std::optional<GimbalAttitude> gimbal;
  std::optional<double> focal_length_mm;
  std::optional<double> focal_length_35mm;          ///< 35 mm equivalent
  std::optional<double> focal_plane_pixels_per_mm;  ///< of the full-size image
  std::optional<double> exposure_s;
  std::optional<double> iso;
  std::optional<double> f_number;
};

/// A photo with its pixels.
struct Photo {
  PhotoMetadata metadata;
  Raster<std::uint8_t> image;  ///< RGB (3 channels) or grey (1), as stored
};

/// A photo whose camera is known: in a metric frame with z up.
struct PhotoPose {
  std::string name;
  CameraModel camera;
  Transform3<frames::Map, frames::Camera> map_from_camera;  ///< of the middle row
  /// Metres, map axes, that the camera flies from the first row to the last (rolling_shutter.hpp).
  Eigen::Vector3d flown_in_readout = Eigen::Vector3d::Zero();
};

}  // namespace nadir
