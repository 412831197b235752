// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "nadir/core/photo.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir {

namespace simulation {
class CameraRays;
}

/// How a drone flies, and how good its camera and its instruments are.
struct FlightOptions {
  double height_m = 45.0;  ///< of the camera above the ground
  double forward_overlap = 0.75;
  double side_overlap = 0.65;
  double speed_m_s = 5.0;

  int image_width = 1600;
  int image_height = 1200;
  double focal_px = 1250.0;
  double k1 = -0.015;  ///< Brown distortion
  double k2 = 0.006;
  double tilt_deg = 0.8;    ///< standard deviation of what the gimbal leaves, about both axes
  double readout_s = 0.02;  ///< of the rolling shutter, first row to last; 0 = global
  double vignetting = 0.25;
  double blur_px = 0.6;
  double noise_grey = 2.5;
  double exposure_drift = 0.06;       ///< standard deviation of the gain, share
  double white_balance_drift = 0.02;  ///< of red and blue against green, share

  bool rtk = false;  ///< positions good to rtk_sigma_m, and said so; else a consumer's receiver
  double rtk_sigma_m = 0.02;
  double gps_bias_m = 1.2;   ///< standard deviation, each axis, one draw a flight; height twice
  double gps_noise_m = 0.3;  ///< standard deviation, each photo and axis
  double gps_lag_s = 0.0;    ///< the position tagged is that of so long ago
  double barometer_m = 0.3;  ///< standard deviation of the relative altitude
  double compass_bias_deg = 2.0;  ///< standard deviation, one draw a flight
  double compass_noise_deg = 0.5;
};
void declare(OptionTable& table, FlightOptions& options);

/// Where a photo is to be taken.
struct Waypoint {
  Stamp stamp;
  Point3<frames::Map> position;
  double yaw = 0.0;  ///< of flight, which is the photo's upward direction
};

struct FlightPlan {
  CameraModel camera;
  std::vector<Waypoint> waypoints;  ///< strips to and fro along the site's longer side
  double along_spacing_m = 0.0;
  double across_spacing_m = 0.0;
};

/// Strips over the whole site; no photo lies more than half a footprint outside it.
FlightPlan plan_flight(const SimulatedWorld& world, const FlightOptions& options);

/// A flight over a scene. Photos are made one at a time: a flight needs the memory of one.
class SimulatedFlight {
 public:
  SimulatedFlight(const SimulatedWorld& world, SimulatedScene scene, const FlightOptions& options,
                  std::uint64_t seed);

  int size() const { return static_cast<int>(plan_.waypoints.size()); }
  const FlightPlan& plan() const { return plan_; }
  /// Exact: the camera's pose in the middle of the exposure, local metres.
  PhotoPose truth(int photo) const;
  /// Velocity of the camera while the shutter is read, map frame, metres per second.
  Eigen::Vector3d velocity(int photo) const;
  /// What its tags say: positions and angles with the errors of the instruments.
  PhotoMetadata metadata(int photo) const;
  Photo render(int photo) const;

 private:
  SimulatedScene scene_;
  FlightOptions options_;
  SiteAnchor anchor_;
  std::uint64_t seed_;
  FlightPlan plan_;
  std::shared_ptr<const simulation::CameraRays> rays_;
};

}  // namespace nadir
