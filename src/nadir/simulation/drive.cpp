// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/drive.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/random.hpp"
#include "nadir/simulation/local_view.hpp"
#include "nadir/simulation/noise.hpp"
#include "nadir/simulation/paint.hpp"
#include "nadir/simulation/world.hpp"

namespace nadir {
namespace {

using simulation::Car;
using simulation::Road;
using simulation::RoadPoint;
using simulation::Source;
using simulation::stream_of;
using simulation::World;

constexpr std::int64_t kFramePeriodNs = 500'000'000;
constexpr double kLongestTravel = 500.0;
constexpr double kShortestSite = 120.0;
constexpr int kLargestLocalSide = 2000;

void check(const char* name, double value, Range allowed) {
  if (value >= allowed.lowest && value <= allowed.highest) return;
  throw Error(ErrorKind::kUsage, std::string(name) + " = " + to_text(value) + " is out of range",
              "simulation",
              "choose " + to_text(allowed.lowest) + " .. " + to_text(allowed.highest));
}

void check(const DriveOptions& options) {
  check("frames", options.frames, {1, 5000});
  check("step_m", options.step_m, {0.0, 20.0});
  check("local_size_m", options.local_size_m, {1.0, 60.0});
  check("local_resolution_m", options.local_resolution_m,
        {options.local_size_m / kLargestLocalSide, options.local_size_m / 4.0});
  check("hole_share", options.hole_share, {0.0, 0.95});
  check("noise_grey", options.noise_grey, {0.0, 100.0});
  check("blur_px", options.blur_px, {0.0, 20.0});
  check("exposure_gain", options.exposure_gain, {0.05, 4.0});
  check("odometry_drift", options.odometry_drift, {-1.0, 1.0});
  check("exposure_gamma", options.exposure_gamma, {0.2, 5.0});
  check("unseen_cars", options.unseen_cars, {0, 100});
  check("frames x step_m", options.frames * options.step_m, {0.0, kLongestTravel});
}

double travel(const DriveOptions& options) { return (options.frames - 1) * options.step_m; }

double site_length(const DriveOptions& options) {
  return std::ceil(std::max(kShortestSite, travel(options) + 2.0 * options.local_size_m + 20.0));
}

/// The robot keeps to the right lane, but nobody drives exactly straight.
RoadPoint driven_point(double along, double phase) {
  return {along, -simulation::kLaneMiddle + 0.22 * std::sin(along / 6.0 + phase)};
}

Trajectory drive_along(const Road& road, double start, double phase, const DriveOptions& options) {
  constexpr double kHalfStep = 0.01;
  Trajectory truth;
  for (int frame = 0; frame < options.frames; ++frame) {
    const double along = start + frame * options.step_m;
    const auto here = road.place(driven_point(along, phase));
    const auto behind = road.place(driven_point(along - kHalfStep, phase));
    const auto ahead = road.place(driven_point(along + kHalfStep, phase));
    truth.push_back({Stamp{frame * kFramePeriodNs},
                     Pose2{here.x, here.y, std::atan2(ahead.y - behind.y, ahead.x - behind.x)}});
  }
  return truth;
}

/// Cars stand near the other kerb, spread over the drive.
std::vector<Car> park_cars(const Road& road, std::uint64_t seed, double start,
                           const DriveOptions& options) {
  constexpr std::array<std::array<double, 3>, 4> kColours{
      {{214, 216, 218}, {52, 56, 64}, {150, 40, 38}, {70, 96, 140}}};
  const RandomStream random(seed, stream_of(Source::kCars));
  std::vector<Car> cars;
  for (int i = 0; i < options.unseen_cars; ++i) {
    const auto draw = 4 * static_cast<std::uint64_t>(i);
    const double share = (i + 0.2 + 0.6 * random.uniform(draw)) / options.unseen_cars;
    const double along = start + share * travel(options);
    const double across = random.uniform(draw + 1, 2.3, 2.6);
    const double turn = random.uniform(draw + 2, -0.05, 0.05);
    const auto colour = static_cast<std::size_t>(4.0 * random.uniform(draw + 3));
    cars.push_back({road.place({along, across}), road.heading(along) + turn, kColours[colour]});
  }
  return cars;
}

/// Accumulates the truth's increments, short by the drift and with a little noise.
std::vector<OdomPose2> dead_reckoning(const Trajectory& truth, std::uint64_t seed,
                                      const DriveOptions& options) {
  constexpr double kNoisePerMetre = 0.01;
  constexpr double kYawNoisePerMetre = 0.0015;  // radians
  const RandomStream random(seed, stream_of(Source::kOdometry));
  std::vector<OdomPose2> odometry(truth.size());
  for (std::size_t i = 1; i < truth.size(); ++i) {
    Motion2 motion = truth[i - 1].pose.inverse() * truth[i].pose;
    const double distance = std::hypot(motion.x, motion.y);
    const auto [forward, left] = random.normal_pair(2 * i);
    motion.x = motion.x * (1.0 - options.odometry_drift) + kNoisePerMetre * distance * forward;
    motion.y = motion.y * (1.0 - options.odometry_drift) + kNoisePerMetre * distance * left;
    motion.yaw += kYawNoisePerMetre * distance * random.normal(2 * i + 1);
    odometry[i] = odometry[i - 1] * motion;
  }
  return odometry;
}

}  // namespace

SimulatedSite simulate_drive(std::uint64_t seed, const DriveOptions& options) {
  check(options);
  const double length = site_length(options);
  World world = simulation::paint_world(seed, length);
  const double start = world.road.along_at(0.5 * (length - travel(options)));
  const double phase = RandomStream(seed, stream_of(Source::kCars)).uniform(1U << 20U, 0.0, 6.0);
  const std::vector<Car> cars = park_cars(world.road, seed, start, options);

  SimulatedSite site;
  site.truth = drive_along(world.road, start, phase, options);
  const std::vector<OdomPose2> odometry = dead_reckoning(site.truth, seed, options);
  for (int frame = 0; frame < options.frames; ++frame) {
    const auto i = static_cast<std::size_t>(frame);
    site.frames.push_back(
        {site.truth[i].stamp,
         simulation::view_from(world, cars, site.truth[i].pose, options, seed, frame),
         odometry[i]});
  }
  site.map = {std::move(world.image), std::move(world.seen), world.geo};
  for (std::size_t i = 0; i < site.map.valid.values().size(); ++i) {
    if (site.map.valid.values()[i] != 0) continue;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      site.map.image.values()[3 * i + channel] = 0;
    }
  }
  return site;
}

}  // namespace nadir
