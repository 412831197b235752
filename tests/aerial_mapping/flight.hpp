// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/core/random.hpp"

namespace nadir::test {

/// Hills and painted ground, 120 x 100 m about the origin, from a seed.
class Terrain {
 public:
  explicit Terrain(std::uint64_t seed = 1, double relief_m = 2.0);

  double height(double x, double y) const;
  /// Colour at a place, 0 .. 255 a channel.
  Eigen::Vector3d colour(double x, double y) const;
  /// Where a ray from above meets the ground.
  Eigen::Vector3d meet(const Eigen::Vector3d& centre, const Eigen::Vector3d& direction) const;
  /// Water: a disc without texture.
  void add_pond(double x, double y, double radius);

 private:
  Raster<std::uint8_t> paint_;
  double relief_m_;
};

/// What goes wrong in a flight.
struct FlightErrors {
  double gps_sigma_m = 0.2;
  Eigen::Vector3d gps_bias = Eigen::Vector3d::Zero();
  double gimbal_sigma_deg = 0.8;
  double exposure_sigma = 0.1;  ///< of ln
  double focal_factor = 1.0;    ///< of the stated focal length
  double focal_sigma = 0.02;    ///< as stated
  double k1 = -0.02;
  double tilt_deg = 3.0;   ///< how far the camera really hangs from the vertical
  double readout_s = 0.0;  ///< of a rolling shutter, first row to last
};

/// Photos of a terrain with everything known about them.
struct Flight {
  std::shared_ptr<const Terrain> terrain;
  CameraModel camera;
  std::vector<Transform3<frames::Map, frames::Camera>> truth;  ///< of a photo's middle row
  std::vector<Eigen::Vector3d> flown;  ///< of a photo, metres from its first row to its last
  PhotoSet set;
};

struct FlightPlan {
  int strips = 3;
  int photos = 4;  ///< a strip
  double step_m = 10.0;
  double strip_step_m = 17.0;
  double height_m = 40.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  std::string prefix = "p";
  std::uint64_t seed = 7;
};

Flight fly(const std::shared_ptr<const Terrain>& terrain, const FlightPlan& plan,
           const FlightErrors& errors);

/// The map against the truth: each map pixel is followed into the photo that gives it its colour
/// and from there, by the true pose, to the ground that is really shown.
struct MapError {
  double relative_rms_m = 0.0;  ///< horizontal, after the best similarity
  double absolute_rms_m = 0.0;
  double scale_error = 0.0;  ///< relative, signed
  Eigen::Vector2d shift_m = Eigen::Vector2d::Zero();
  double height_rms_m = 0.0;  ///< of the surface, after its mean and tilt are taken out
  double bowl_m = 0.0;        ///< height of the surface at the corners over that of the middle
  int pixels = 0;
};
MapError compare(const Flight& flight, const AerialMap& map);

}  // namespace nadir::test
