// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_flight.hpp"

#include <array>
#include <cmath>
#include <string>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/core/random.hpp"
#include "nadir/core/rolling_shutter.hpp"
#include "nadir/simulation/sensing/camera_view.hpp"
#include "nadir/simulation/sensing/draw_index.hpp"
#include "nadir/simulation/sensing/tone.hpp"

namespace nadir {
namespace {

using simulation::draw_index;

// Streams of random numbers of a flight.
enum FlightStream : std::uint64_t {
  kFlightBias = 3000,
  kPositions,
  kAngles,
  kTilts,
  kExposures,
  kPhotoNoise = 1'000'000,
};

constexpr std::int64_t kTakeOff = 1'747'044'000LL * 1'000'000'000LL;  // 2025-05-12 10:00:00
constexpr double kTurnSeconds = 6.0;                                  ///< between two strips
constexpr double kPixelsPerMillimetre = 400.0;

CameraModel camera_of(const FlightOptions& options) {
  CameraModel camera;
  camera.width = options.image_width;
  camera.height = options.image_height;
  camera.fx = camera.fy = options.focal_px;
  camera.cx = 0.5 * (options.image_width - 1);
  camera.cy = 0.5 * (options.image_height - 1);
  camera.k1 = options.k1;
  camera.k2 = options.k2;
  return camera;
}

/// So many stops, evenly over `extent`, that the outer footprints reach well beyond its ends.
int stops_over(double extent, double footprint, double spacing) {
  return std::max(2, 1 + static_cast<int>(std::ceil((extent - 0.5 * footprint) / spacing)));
}

/// Looking down, the upper edge of the image towards `yaw`.
Eigen::Quaterniond nadir_rotation(double yaw) {
  Eigen::Matrix3d axes;
  axes.col(0) << std::sin(yaw), -std::cos(yaw), 0.0;
  axes.col(1) << -std::cos(yaw), -std::sin(yaw), 0.0;
  axes.col(2) << 0.0, 0.0, -1.0;
  return Eigen::Quaterniond(axes);
}

}  // namespace

FlightPlan plan_flight(const SimulatedWorld& world, const FlightOptions& options) {
  FlightPlan plan;
  plan.camera = camera_of(options);
  const double across = options.height_m * options.image_width / options.focal_px;
  const double along = options.height_m * options.image_height / options.focal_px;
  plan.across_spacing_m = across * (1.0 - options.side_overlap);
  plan.along_spacing_m = along * (1.0 - options.forward_overlap);
  const bool east = world.width_m() >= world.depth_m();
  const Eigen::Vector2d middle(0.5 * world.width_m(), 0.5 * world.depth_m());
  const double length = east ? world.width_m() : world.depth_m();
  const double breadth = east ? world.depth_m() : world.width_m();
  const int strips = stops_over(breadth, across, plan.across_spacing_m);
  const int stops = stops_over(length, along, plan.along_spacing_m);
  double seconds = 0.0;
  for (int strip = 0; strip < strips; ++strip) {
    const double sign = (strip & 1) == 0 ? 1.0 : -1.0;
    for (int stop = 0; stop < stops; ++stop) {
      const double u = sign * (stop - 0.5 * (stops - 1)) * plan.along_spacing_m;
      const double v = (strip - 0.5 * (strips - 1)) * plan.across_spacing_m;
      Waypoint waypoint;
      waypoint.position = {middle.x() + (east ? u : v), middle.y() + (east ? v : u),
                           options.height_m};
      waypoint.yaw = (east ? 0.0 : 0.5 * kPi) + (sign < 0.0 ? -kPi : 0.0);
      waypoint.yaw = wrap_angle(waypoint.yaw);
      waypoint.stamp = {kTakeOff + std::llround(seconds * 1e9)};
      plan.waypoints.push_back(waypoint);
      seconds += plan.along_spacing_m / options.speed_m_s;
    }
    seconds += kTurnSeconds;
  }
  return plan;
}

SimulatedFlight::SimulatedFlight(const SimulatedWorld& world, SimulatedScene scene,
                                 const FlightOptions& options, std::uint64_t seed)
    : scene_(std::move(scene)),
      options_(options),
      anchor_(world.anchor()),
      seed_(seed),
      plan_(plan_flight(world, options)),
      rays_(std::make_shared<simulation::CameraRays>(plan_.camera)) {}

PhotoPose SimulatedFlight::truth(int photo) const {
  const Waypoint& waypoint = plan_.waypoints[static_cast<std::size_t>(photo)];
  const RandomStream random(seed_, kTilts);
  const auto [forward, sideward] = random.normal_pair(2 * draw_index(photo));
  const auto [drift, climb] = random.normal_pair(2 * draw_index(photo) + 1);
  const double tilt = radians(options_.tilt_deg);
  PhotoPose pose;
  pose.name = "photo_" +
              std::string(photo < 9    ? "00"
                          : photo < 99 ? "0"
                                       : "") +
              std::to_string(photo + 1) + ".jpg";
  pose.camera = plan_.camera;
  // The drone keeps neither its line nor its height exactly, and flies a little crabwise.
  const double yaw = waypoint.yaw + radians(1.5) * std::sin(0.7 * photo);
  pose.map_from_camera.rotation = nadir_rotation(yaw) *
                                  Eigen::AngleAxisd(tilt * forward, Eigen::Vector3d::UnitX()) *
                                  Eigen::AngleAxisd(tilt * sideward, Eigen::Vector3d::UnitY());
  pose.map_from_camera.translation =
      waypoint.position.vector() + Eigen::Vector3d(-0.25 * drift * std::sin(waypoint.yaw),
                                                   0.25 * drift * std::cos(waypoint.yaw),
                                                   0.2 * climb);
  pose.flown_in_readout = options_.readout_s * velocity(photo);
  return pose;
}

Eigen::Vector3d SimulatedFlight::velocity(int photo) const {
  const Waypoint& waypoint = plan_.waypoints[static_cast<std::size_t>(photo)];
  return options_.speed_m_s * Eigen::Vector3d(std::cos(waypoint.yaw), std::sin(waypoint.yaw), 0.0);
}

PhotoMetadata SimulatedFlight::metadata(int photo) const {
  const PhotoPose pose = truth(photo);
  const std::uint64_t index = draw_index(photo);
  const RandomStream positions(seed_, kPositions);
  const RandomStream angles(seed_, kAngles);
  const RandomStream bias(seed_, kFlightBias);
  const auto [bias_x, bias_y] = bias.normal_pair(0);
  const auto [bias_z, compass] = bias.normal_pair(1);
  const auto [noise_x, noise_y] = positions.normal_pair(2 * index);
  const auto [noise_z, noise_barometer] = positions.normal_pair(2 * index + 1);
  const Eigen::Vector3d drawn(noise_x, noise_y, noise_z);
  Eigen::Vector3d error = options_.rtk_sigma_m * Eigen::Vector3d(1.0, 1.0, 1.5).cwiseProduct(drawn);
  if (!options_.rtk) {
    error = options_.gps_bias_m * Eigen::Vector3d(bias_x, bias_y, 2.0 * bias_z) +
            options_.gps_noise_m * Eigen::Vector3d(1.0, 1.0, 2.0).cwiseProduct(drawn);
  }
  const Eigen::Vector3d& true_position = pose.map_from_camera.translation;
  const Eigen::Vector3d position = true_position - options_.gps_lag_s * velocity(photo) + error;

  PhotoMetadata tags;
  tags.name = pose.name;
  tags.width = plan_.camera.width;
  tags.height = plan_.camera.height;
  tags.exif_width = tags.width;
  tags.exif_height = tags.height;
  tags.make = "nadir";
  tags.model = "simulated camera";
  tags.taken_at = plan_.waypoints[static_cast<std::size_t>(photo)].stamp;
  tags.position = anchor_.geodetic(Point3<frames::Map>::from(position));
  if (options_.rtk) {
    tags.position->horizontal_sigma_m = options_.rtk_sigma_m;
    tags.position->vertical_sigma_m = 1.5 * options_.rtk_sigma_m;
  }
  tags.relative_altitude_m = true_position.z() + options_.barometer_m * noise_barometer;
  const auto [yaw_noise, pitch_noise] = angles.normal_pair(index);
  const Eigen::Vector3d up = pose.map_from_camera.rotation * -Eigen::Vector3d::UnitY();
  const Eigen::Vector3d axis = pose.map_from_camera.rotation * Eigen::Vector3d::UnitZ();
  const double heading = 0.5 * kPi - std::atan2(up.y(), up.x()) +
                         anchor_.convergence(Point3<frames::Map>::from(true_position));
  GimbalAttitude gimbal;
  gimbal.yaw_deg = degrees(wrap_angle(heading)) + options_.compass_bias_deg * compass +
                   options_.compass_noise_deg * yaw_noise;
  const double forward_tilt =
      std::atan2(axis.dot(Eigen::Vector3d(up.x(), up.y(), 0.0).normalized()), -axis.z());
  gimbal.pitch_deg = -90.0 + degrees(forward_tilt) + 0.1 * pitch_noise;
  tags.gimbal = gimbal;
  tags.focal_length_mm = options_.focal_px / kPixelsPerMillimetre;
  tags.focal_plane_pixels_per_mm = kPixelsPerMillimetre;
  tags.focal_length_35mm = 36.0 * options_.focal_px / options_.image_width;
  tags.exposure_s = 1.0 / 800.0;
  tags.iso = 100.0;
  tags.f_number = 2.8;
  return tags;
}

Photo SimulatedFlight::render(int photo) const {
  const PhotoPose pose = truth(photo);
  const Stamp stamp = plan_.waypoints[static_cast<std::size_t>(photo)].stamp;
  const simulation::Movers movers =
      scene_.scene().traffic(static_cast<double>(stamp.nanoseconds - kTakeOff) * 1e-9);
  const Raster<float> linear = simulation::view(
      scene_.scene(), *rays_,
      [&](int row) {
        simulation::CameraPose at = pose.map_from_camera;
        at.translation += readout_share(plan_.camera, row) * pose.flown_in_readout;
        return at;
      },
      &movers);
  const RandomStream random(seed_, kExposures);
  const auto [exposure, red] = random.normal_pair(2 * draw_index(photo));
  const double blue = random.normal(2 * draw_index(photo) + 1);
  simulation::Development development;
  const double gain = std::exp(options_.exposure_drift * exposure);
  development.gain = {static_cast<float>(gain * std::exp(options_.white_balance_drift * red)),
                      static_cast<float>(gain),
                      static_cast<float>(gain * std::exp(options_.white_balance_drift * blue))};
  development.vignetting = static_cast<float>(options_.vignetting);
  development.blur_px = static_cast<float>(options_.blur_px);
  development.noise_grey = static_cast<float>(options_.noise_grey);
  development.seed = seed_;
  development.stream = kPhotoNoise + draw_index(photo);
  return {metadata(photo), simulation::develop(linear, development)};
}

}  // namespace nadir
