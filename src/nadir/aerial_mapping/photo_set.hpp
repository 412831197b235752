// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/attitude.hpp"
#include "nadir/aerial_mapping/focal_prior.hpp"
#include "nadir/core/frames3.hpp"
#include "nadir/core/photo.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/stamp.hpp"

namespace nadir {

/// One camera (make, model, size, zoom): its photos share their intrinsics.
struct CameraPrior {
  std::string name;  ///< for reports
  int width = 0;     ///< pixels of the photos at their working size
  int height = 0;
  FocalPrior focal;  ///< pixels at the working size
};

/// What is known of a photo before its pixels are looked at. Absent = unknown.
struct PhotoPrior {
  /// GPS fix of the camera in the map frame (z up; any datum, the same for all photos).
  std::optional<Point3<frames::Map>> position;
  /// Standard deviations of the fix, where the photo says them (RTK, a list of positions); else
  /// those of the options hold.
  std::optional<double> horizontal_sigma_m;
  std::optional<double> vertical_sigma_m;
  std::optional<PhotoAttitude> attitude;
  std::optional<double> relative_altitude_m;  ///< above the take-off
  std::optional<Stamp> taken_at;
  /// Exposure t ISO / N^2 (s), on which only ratios between photos matter.
  std::optional<double> exposure;
};

/// A photo at its working size.
struct MappingPhoto {
  std::string name;        ///< unique; the photo's identity: order and random numbers follow it
  std::size_t camera = 0;  ///< index into PhotoSet::cameras
  std::string digest;      ///< names the pixels, for a MappingStore; empty = not to be kept
  PhotoPrior prior;
  /// Gives the pixels, RGB or grey, of the camera's size. Called from several threads, for
  /// different photos at the same time, and more than once a photo, so that memory stays bounded.
  std::function<Raster<std::uint8_t>()> load;
  /// A pose that is known already, in the map frame, for the working size. Where every photo has
  /// one, nothing is solved (AerialMappingOptions::refine_given_poses).
  std::optional<PhotoPose> pose;
};

/// A point whose place in the map is known, and where it is seen.
struct GroundControlPoint {
  struct Mark {
    std::string photo;
    double u = 0.0;  ///< pixel at the working size, (0, 0) = centre of the first pixel
    double v = 0.0;
  };
  std::string name;
  Point3<frames::Map> position;
  double horizontal_sigma_m = 0.03;
  double vertical_sigma_m = 0.05;
  std::vector<Mark> marks;
};

/// All that a map is made from.
struct PhotoSet {
  std::vector<CameraPrior> cameras;
  std::vector<MappingPhoto> photos;  ///< in any order
  std::vector<GroundControlPoint> control_points;
  /// Size of a pixel of the photos (working size) on the ground, metres: gives the scale where
  /// there are neither positions nor control points.
  std::optional<double> metres_per_photo_pixel;
  std::string crs;  ///< of the map frame as WKT; empty = local metres
};

}  // namespace nadir
