// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/sensors.hpp"
#include "nadir/core/trajectory.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir {

namespace simulation {
class CameraRays;
struct Movers;
}  // namespace simulation

/// How a robot drives, and how good its odometry is.
struct RouteOptions {
  int route = 0;        ///< of SimulatedWorld::routes()
  int frames = 0;       ///< 0 = to the end of the route
  double step_m = 0.8;  ///< travel between frames
  double speed_m_s = 2.0;
  double start_m = 2.0;          ///< along the route
  double lane_offset_m = -1.75;  ///< where there are lanes: to the left of the road's middle
  double stamp_jitter_s = 0.002;
  double shake_deg = 0.15;  ///< standard deviation of pitch and roll against the ground

  double odometry_scale = -0.01;         ///< of the distance: it falls short by 1 %
  double odometry_noise = 0.01;          ///< standard deviation, metres per root metre
  double odometry_yaw_deg_per_m = 0.02;  ///< steady drift of the heading
  double odometry_yaw_noise_deg = 0.1;   ///< standard deviation, degrees per root metre
};
void declare(OptionTable& table, RouteOptions& options);

struct StereoOptions {
  int image_width = 640;
  int image_height = 480;
  double focal_px = 380.0;
  double baseline_m = 0.20;
  double mast_m = 1.0;      ///< of the left camera above the robot's ground
  double pitch_deg = 16.0;  ///< downwards
  double blur_px = 0.5;
  double noise_grey = 2.0;
  double vignetting = 0.12;
  double exposure_drift = 0.04;
  double brightness = 0.9;  ///< gain against the drone's camera
  bool colour = true;
};
void declare(OptionTable& table, StereoOptions& options);

struct LidarOptions {
  int rings = 32;
  double lowest_deg = -25.0;
  double highest_deg = 5.0;
  int columns = 900;    ///< points of a ring
  double mast_m = 1.3;  ///< above the robot's ground
  double range_noise_m = 0.02;
  double dropout = 0.03;  ///< share of the points that do not come back
  double shortest_m = 0.8;
  double longest_m = 50.0;
  double sweep_s = 0.0;  ///< time of a turn; 0 = already freed of the robot's motion
  bool camera = true;    ///< one that looks forward, as the left of StereoOptions does
};
void declare(OptionTable& table, LidarOptions& options);

/// What the true local map covers.
struct LocalTruthOptions {
  double size_m = 18.0;
  double resolution_m = 0.10;
  double ceiling_m = 1.5;  ///< what is higher above the robot's ground is not there
  /// Only what the cameras could have seen, from this frame or those before it, is valid.
  bool only_seen = true;
  double range_m = 10.0;  ///< how far from a camera a place counts as seen
};

/// A drive along a route of the world, with exact truth.
class SimulatedDrive {
 public:
  /// Refines the scene along the route. Throws Error (usage) where there is no such route, or it is
  /// shorter than two frames.
  SimulatedDrive(const SimulatedWorld& world, SimulatedScene scene, const RouteOptions& route,
                 std::uint64_t seed, const StereoOptions& stereo = {},
                 const LidarOptions& lidar = {});

  int size() const { return static_cast<int>(poses_.size()); }
  Stamp stamp(int frame) const { return stamps_[static_cast<std::size_t>(frame)]; }
  /// Exact; the robot's origin is on the ground, z along the ground's normal.
  const Transform3<frames::Map, frames::Robot>& map_from_robot(int frame) const {
    return poses_[static_cast<std::size_t>(frame)];
  }
  /// As the robot's odometry says it, with drift and noise; it starts near the origin, level.
  const OdomPose3& odom_from_robot(int frame) const {
    return odometry_[static_cast<std::size_t>(frame)];
  }
  Trajectory truth() const;
  std::vector<StampedOdomPose3> odometry() const;

  const StereoRig& stereo_rig() const { return stereo_rig_; }
  StereoFrame stereo(int frame) const;
  const LidarRig& lidar_rig() const { return lidar_rig_; }
  LidarFrame lidar(int frame) const;
  /// The exact local orthomosaic and elevation of a frame, robot at the centre, with its odometry.
  Frame true_local(int frame, const LocalTruthOptions& options) const;

 private:
  void drive(const SimulatedWorld& world, const std::vector<Pose2>& route);
  void measure_odometry();
  simulation::Movers traffic(int frame) const;
  Transform3<frames::Map, frames::Robot> settled(const SimulatedWorld& world, const Pose2& pose,
                                                 int frame) const;
  Raster<std::uint8_t> camera_image(int frame, const simulation::CameraRays& rays,
                                    const Transform3<frames::Map, frames::Camera>& pose,
                                    std::uint64_t stream) const;

  SimulatedScene scene_;
  RouteOptions route_options_;
  StereoOptions stereo_options_;
  LidarOptions lidar_options_;
  std::uint64_t seed_;
  StereoRig stereo_rig_;
  LidarRig lidar_rig_;
  std::vector<Stamp> stamps_;
  std::vector<Transform3<frames::Map, frames::Robot>> poses_;
  std::vector<OdomPose3> odometry_;
  std::shared_ptr<const simulation::CameraRays> rays_;
};

}  // namespace nadir
