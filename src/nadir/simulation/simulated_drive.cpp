// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_drive.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/sensing/camera_view.hpp"
#include "nadir/simulation/sensing/draw_index.hpp"
#include "nadir/simulation/sensing/lidar_scan.hpp"
#include "nadir/simulation/sensing/local_truth.hpp"
#include "nadir/simulation/sensing/tone.hpp"

namespace nadir {
namespace {

using simulation::draw_index;

// Streams of random numbers of a drive.
enum DriveStream : std::uint64_t {
  kStamps = 4000,
  kShake,
  kSlip,
  kTurnSlip,
  kDriveExposures,
  kScanNoise = 2'000'000,
  kLeftNoise = 3'000'000,
  kRightNoise = 4'000'000,
};

constexpr std::int64_t kStart = 1'748'880'000LL * 1'000'000'000LL;
constexpr double kRefined = 7.0;  ///< metres from the route that are drawn in finest detail

using MapFromRobot = Transform3<frames::Map, frames::Robot>;

CameraModel camera_of(const StereoOptions& options) {
  CameraModel camera;
  camera.width = options.image_width;
  camera.height = options.image_height;
  camera.fx = camera.fy = options.focal_px;
  camera.cx = 0.5 * (options.image_width - 1);
  camera.cy = 0.5 * (options.image_height - 1);
  return camera;
}

StereoRig rig_of(const StereoOptions& options) {
  StereoRig rig;
  rig.left = rig.right = camera_of(options);
  rig.right_from_left.translation = {-options.baseline_m, 0.0, 0.0};
  const Eigen::AngleAxisd pitch(radians(options.pitch_deg), Eigen::Vector3d::UnitY());
  rig.robot_from_left.rotation = pitch * forward_camera_rotation();
  rig.robot_from_left.translation = {0.3, 0.5 * options.baseline_m, options.mast_m};
  rig.rectified = true;
  return rig;
}

LidarRig rig_of(const LidarOptions& options, const StereoRig& stereo) {
  LidarRig rig;
  rig.robot_from_lidar.translation = {0.0, 0.0, options.mast_m};
  if (options.camera) rig.cameras.push_back({stereo.left, stereo.robot_from_left});
  return rig;
}

Pose2 shifted_left(const Pose2& pose, double offset) {
  return {pose.x - offset * std::sin(pose.yaw), pose.y + offset * std::cos(pose.yaw), pose.yaw};
}

}  // namespace

SimulatedDrive::SimulatedDrive(const SimulatedWorld& world, SimulatedScene scene,
                               const RouteOptions& route, std::uint64_t seed,
                               const StereoOptions& stereo, const LidarOptions& lidar)
    : scene_(std::move(scene)),
      route_options_(route),
      stereo_options_(stereo),
      lidar_options_(lidar),
      seed_(seed),
      stereo_rig_(rig_of(stereo)),
      lidar_rig_(rig_of(lidar, stereo_rig_)),
      rays_(std::make_shared<simulation::CameraRays>(stereo_rig_.left)) {
  const auto routes = world.routes();
  if (route.route < 0 || route.route >= static_cast<int>(routes.size())) {
    throw Error(ErrorKind::kUsage, "the world has no route " + std::to_string(route.route),
                "simulation.drive_route", "it has " + std::to_string(routes.size()));
  }
  drive(world, routes[static_cast<std::size_t>(route.route)]);
  measure_odometry();
  std::vector<Pose2> places;
  for (const MapFromRobot& pose : poses_) places.push_back(planar(pose));
  scene_.refine(places, kRefined);
}

/// Where the four wheels stand decides height, pitch and roll.
MapFromRobot SimulatedDrive::settled(const SimulatedWorld& world, const Pose2& pose,
                                     int frame) const {
  constexpr double kHalfWheelbase = 0.35;
  constexpr double kHalfTrack = 0.3;
  const auto wheel = [&](double forward, double left) {
    const Point2<frames::Map> p = pose * Point2<frames::Robot>{forward, left};
    return Eigen::Vector3d(p.x, p.y, world.ground_height(p.x, p.y));
  };
  const Eigen::Vector3d front_left = wheel(kHalfWheelbase, kHalfTrack);
  const Eigen::Vector3d front_right = wheel(kHalfWheelbase, -kHalfTrack);
  const Eigen::Vector3d back_left = wheel(-kHalfWheelbase, kHalfTrack);
  const Eigen::Vector3d back_right = wheel(-kHalfWheelbase, -kHalfTrack);
  const Eigen::Vector3d forward = (front_left + front_right - back_left - back_right).normalized();
  const Eigen::Vector3d aside = front_left + back_left - front_right - back_right;
  Eigen::Matrix3d axes;
  axes.col(0) = forward;
  axes.col(2) = forward.cross(aside).normalized();
  axes.col(1) = axes.col(2).cross(forward);
  const auto [pitch, roll] = RandomStream(seed_, kShake).normal_pair(draw_index(frame));
  const double shake = radians(route_options_.shake_deg);
  MapFromRobot settled;
  settled.rotation = Eigen::Quaterniond(axes) *
                     Eigen::AngleAxisd(shake * pitch, Eigen::Vector3d::UnitY()) *
                     Eigen::AngleAxisd(shake * roll, Eigen::Vector3d::UnitX());
  settled.rotation.normalize();
  settled.translation = 0.25 * (front_left + front_right + back_left + back_right);
  return settled;
}

void SimulatedDrive::drive(const SimulatedWorld& world, const std::vector<Pose2>& route) {
  constexpr double kRouteStep = 0.5;  // as SimulatedWorld::routes() has it
  const double length = static_cast<double>(route.size() - 1) * kRouteStep;
  const auto fit = static_cast<int>((length - route_options_.start_m) / route_options_.step_m) + 1;
  const int count = route_options_.frames > 0 ? route_options_.frames : fit;
  if (count > fit || count < 2) {
    throw Error(ErrorKind::kUsage,
                std::to_string(count) + " frames do not fit a route of " +
                    std::to_string(static_cast<int>(length)) + " m",
                "simulation.drive_frames",
                "at most " + std::to_string(fit) + " do with this start and step");
  }
  const double aside = world.has_lanes() ? route_options_.lane_offset_m : 0.0;
  const RandomStream jitter(seed_, kStamps);
  for (int frame = 0; frame < count; ++frame) {
    const double along = (route_options_.start_m + frame * route_options_.step_m) / kRouteStep;
    const auto below = std::min(static_cast<std::size_t>(along), route.size() - 2);
    const double share = along - static_cast<double>(below);
    const Pose2& a = route[below];
    const Pose2& b = route[below + 1];
    Pose2 pose{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
               wrap_angle(a.yaw + share * wrap_angle(b.yaw - a.yaw))};
    poses_.push_back(settled(world, shifted_left(pose, aside), frame));
    const double seconds = frame * route_options_.step_m / route_options_.speed_m_s +
                           route_options_.stamp_jitter_s * jitter.uniform(draw_index(frame), -1, 1);
    stamps_.push_back({kStart + std::llround(seconds * 1e9)});
  }
}

void SimulatedDrive::measure_odometry() {
  const RandomStream slip(seed_, kSlip);
  const RandomStream turn(seed_, kTurnSlip);
  OdomPose2 at;
  double height = 0.0;
  for (int frame = 0; frame < size(); ++frame) {
    const MapFromRobot& pose = map_from_robot(frame);
    if (frame > 0) {
      const Pose2 before = planar(map_from_robot(frame - 1));
      const Motion2 moved = [&] {
        const auto back = before.inverse() * planar(pose);
        return Motion2{back.x, back.y, back.yaw};
      }();
      const double distance = std::hypot(moved.x, moved.y);
      const double root = std::sqrt(distance);
      const auto [along, across] = slip.normal_pair(2 * draw_index(frame));
      const double up = slip.normal(2 * draw_index(frame) + 1);
      const double scale = 1.0 + route_options_.odometry_scale;
      const Motion2 noisy{scale * moved.x + route_options_.odometry_noise * root * along,
                          scale * moved.y + route_options_.odometry_noise * root * across,
                          moved.yaw + radians(route_options_.odometry_yaw_deg_per_m) * distance +
                              radians(route_options_.odometry_yaw_noise_deg) * root *
                                  turn.normal(draw_index(frame))};
      at = at * noisy;
      height += pose.translation.z() - map_from_robot(frame - 1).translation.z() +
                0.5 * route_options_.odometry_noise * root * up;
    }
    // Gravity tells roll and pitch; only the heading drifts.
    const Eigen::Quaterniond tilt =
        Eigen::AngleAxisd(-yaw_of(pose), Eigen::Vector3d::UnitZ()) * pose.rotation;
    OdomPose3 odom;
    odom.rotation = Eigen::AngleAxisd(at.yaw, Eigen::Vector3d::UnitZ()) * tilt;
    odom.rotation.normalize();
    odom.translation = {at.x, at.y, height};
    odometry_.push_back(odom);
  }
}

Trajectory SimulatedDrive::truth() const {
  Trajectory trajectory;
  for (int frame = 0; frame < size(); ++frame) {
    trajectory.push_back({stamp(frame), planar(map_from_robot(frame))});
  }
  return trajectory;
}

std::vector<StampedOdomPose3> SimulatedDrive::odometry() const {
  std::vector<StampedOdomPose3> odometry;
  for (int frame = 0; frame < size(); ++frame) {
    odometry.push_back({stamp(frame), odom_from_robot(frame)});
  }
  return odometry;
}

/// The cars under way, but for those that would run into the robot.
simulation::Movers SimulatedDrive::traffic(int frame) const {
  constexpr double kClear = 9.0;
  simulation::Movers movers =
      scene_.scene().traffic(static_cast<double>(stamp(frame).nanoseconds - kStart) * 1e-9);
  const Pose2 robot = planar(map_from_robot(frame));
  std::erase_if(movers.things, [&](const simulation::Movers::Thing& thing) {
    const Eigen::Vector3d centre = thing.box.center();
    const auto at = robot.inverse() * Point2<frames::Map>{centre.x(), centre.y()};
    return std::abs(at.x) < kClear && std::abs(at.y) < 2.5;
  });
  return movers;
}

Raster<std::uint8_t> SimulatedDrive::camera_image(
    int frame, const simulation::CameraRays& rays,
    const Transform3<frames::Map, frames::Camera>& pose, std::uint64_t stream) const {
  const Raster<float> linear = simulation::view(scene_.scene(), rays, [&](int) { return pose; });
  const double drift = RandomStream(seed_, kDriveExposures).normal(draw_index(frame));
  simulation::Development development;
  development.gain = Eigen::Vector3f::Constant(static_cast<float>(
      stereo_options_.brightness * std::exp(stereo_options_.exposure_drift * drift)));
  development.vignetting = static_cast<float>(stereo_options_.vignetting);
  development.blur_px = static_cast<float>(stereo_options_.blur_px);
  development.noise_grey = static_cast<float>(stereo_options_.noise_grey);
  development.grey = !stereo_options_.colour;
  development.seed = seed_;
  development.stream = stream;
  return simulation::develop(linear, development);
}

StereoFrame SimulatedDrive::stereo(int frame) const {
  const auto left = map_from_robot(frame) * stereo_rig_.robot_from_left;
  const auto right_from_left = stereo_rig_.right_from_left;
  const auto right = left * right_from_left.inverse();
  // Both eyes are cameras of the same make: the same rays from another place.
  const simulation::CameraPose right_eye{right.rotation, right.translation};
  return {stamp(frame), camera_image(frame, *rays_, left, kLeftNoise + draw_index(frame)),
          camera_image(frame, *rays_, right_eye, kRightNoise + draw_index(frame))};
}

LidarFrame SimulatedDrive::lidar(int frame) const {
  const int next = std::min(frame + 1, size() - 1);
  const simulation::Sweep sweep{map_from_robot(frame), map_from_robot(next),
                                std::max(1e-3, (stamp(next).seconds() - stamp(frame).seconds()))};
  const simulation::Movers movers = traffic(frame);
  LidarFrame scan;
  scan.stamp = stamp(frame);
  scan.points = simulation::scan(scene_.scene(), sweep, lidar_rig_, lidar_options_, seed_,
                                 kScanNoise + draw_index(frame), movers);
  for (const MountedCamera& camera : lidar_rig_.cameras) {
    const auto pose = map_from_robot(frame) * camera.robot_from_camera;
    scan.images.push_back(camera_image(frame, *rays_, pose, kLeftNoise + draw_index(frame)));
  }
  return scan;
}

Frame SimulatedDrive::true_local(int frame, const LocalTruthOptions& options) const {
  std::vector<MapFromRobot> seen_from;
  if (options.only_seen) {
    const int reach = static_cast<int>(options.size_m / route_options_.step_m);
    for (int past = frame; past >= std::max(0, frame - reach); --past) {
      seen_from.push_back(map_from_robot(past));
    }
  }
  const simulation::LocalTruth truth = simulation::local_truth(
      scene_.scene(), map_from_robot(frame), options, stereo_rig_, seen_from);
  Frame result;
  result.stamp = stamp(frame);
  result.local = truth.local;
  result.odom_from_robot = planar(odom_from_robot(frame));
  result.elevation = truth.elevation;
  return result;
}

}  // namespace nadir
