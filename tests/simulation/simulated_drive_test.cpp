// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_drive.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "simulation/dotted_world.hpp"
#include "simulation/small_world.hpp"

namespace nadir {
namespace {

using test::campus;

Appearance quiet() {
  Appearance appearance = drive_appearance();
  appearance.cars_per_km = 0.0;
  return appearance;
}

const SimulatedScene& campus_scene() {
  static const SimulatedScene kScene = campus().seen(quiet());
  return kScene;
}

RouteOptions few_frames(int frames) {
  RouteOptions route;
  route.frames = frames;
  return route;
}

StereoOptions small_stereo() {
  StereoOptions options;
  options.image_width = 160;
  options.image_height = 120;
  options.focal_px = 95.0;
  return options;
}

TEST(SimulatedDrive, DisparitiesAreThoseOfTheGeometry) {
  constexpr double kHeight = 0.5;
  const test::DottedWorld dotted = test::dotted_world(kHeight, 0.2, 0.05);
  StereoOptions options;
  options.blur_px = options.noise_grey = options.vignetting = options.exposure_drift = 0.0;
  RouteOptions route = few_frames(2);
  route.shake_deg = 1.0;
  const SimulatedDrive drive(dotted.world, dotted.world.seen(quiet()), route, 1, options);
  const StereoFrame frame = drive.stereo(1);
  const StereoRig& rig = drive.stereo_rig();
  EXPECT_TRUE(rig.rectified);
  EXPECT_DOUBLE_EQ(rig.baseline_m(), options.baseline_m);
  const auto map_from_left = drive.map_from_robot(1) * rig.robot_from_left;
  // What the left eye sees on the level ground is looked up in the right image, beside the place
  // where the rig says it is: likeness must peak at no shift at all.
  std::vector<double> likeness;
  for (const double shift : {-0.5, 0.0, 0.5}) {
    std::vector<double> left;
    std::vector<double> right;
    for (int v = 200; v < options.image_height; v += 2) {
      for (int u = 60; u < options.image_width; u += 2) {
        const Eigen::Vector3d ray = rig.left.ray(Eigen::Vector2d(u, v));
        const Eigen::Vector3d in_map = map_from_left.rotation * ray;
        const double depth = (kHeight - map_from_left.translation.z()) / in_map.z();
        const auto in_right = rig.right_from_left * Point3<frames::Camera>::from(depth * ray);
        const auto pixel = rig.right.project(in_right.vector());
        EXPECT_NEAR(pixel->x(), u - options.focal_px * options.baseline_m / depth, 1e-9);
        EXPECT_NEAR(pixel->y(), v, 1e-9);
        const double place = pixel->x() + shift;
        const int column = static_cast<int>(place);
        if (place < 0.0 || column + 1 >= options.image_width) continue;
        const double share = place - column;
        left.push_back(frame.left.at(u, v, 1));
        right.push_back((1.0 - share) * frame.right.at(column, v, 1) +
                        share * frame.right.at(column + 1, v, 1));
      }
    }
    ASSERT_GT(left.size(), 20000U);
    likeness.push_back(test::zncc(left, right));
  }
  EXPECT_GT(likeness[1], 0.98);
  const double bend = likeness[0] - 2.0 * likeness[1] + likeness[2];
  EXPECT_LT(bend, 0.0);
  EXPECT_NEAR(0.5 * 0.5 * (likeness[0] - likeness[2]) / bend, 0.0, 0.05);  // of the parabola, px
}

TEST(SimulatedDrive, LidarPointsLieOnTheSurface) {
  LidarOptions options;
  options.rings = 16;
  options.columns = 180;
  options.range_noise_m = options.dropout = 0.0;
  options.camera = false;
  const SimulatedDrive drive(campus(), campus_scene(), few_frames(3), 1, small_stereo(), options);
  const LidarFrame scan = drive.lidar(2);
  EXPECT_TRUE(scan.images.empty());
  const auto map_from_lidar = drive.map_from_robot(2) * drive.lidar_rig().robot_from_lidar;
  const auto origin = Point3<frames::Map>::from(map_from_lidar.translation);
  ASSERT_GT(scan.points.size(), 1000U);
  int on_ground = 0;
  int off = 0;
  for (const LidarPoint& point : scan.points) {
    const double range = std::hypot(point.x, point.y, point.z);
    EXPECT_LE(range, options.longest_m + 1e-3);
    const auto at = [&](double reach) {
      const double share = reach / range;
      return map_from_lidar *
             Point3<frames::Lidar>{share * point.x, share * point.y, share * point.z};
    };
    const double margin = 0.01 + 0.004 * range;  // on the ground far away a beam grazes
    if (!campus_scene().sees(origin, at(range - margin)) ||
        campus_scene().sees(origin, at(range + margin))) {
      ++off;
    }
    const auto p = at(range);
    if (std::abs(p.z - campus().ground_height(p.x, p.y)) < 2e-3) ++on_ground;
  }
  EXPECT_GT(on_ground, 300);
  // Rounded to float, a beam may miss the leaf that it had met.
  EXPECT_LT(off, static_cast<int>(scan.points.size()) / 100);
}

TEST(SimulatedDrive, LidarHasTheNoiseAndTheDropoutsAskedFor) {
  LidarOptions options;
  options.rings = 16;
  options.columns = 300;
  options.camera = false;
  options.range_noise_m = options.dropout = 0.0;
  const SimulatedDrive exact(campus(), campus_scene(), few_frames(2), 1, small_stereo(), options);
  options.range_noise_m = 0.03;
  const SimulatedDrive noisy(campus(), campus_scene(), few_frames(2), 1, small_stereo(), options);
  const auto truth = exact.lidar(0).points;
  const auto points = noisy.lidar(0).points;
  ASSERT_EQ(points.size(), truth.size());
  double squares = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double error = std::hypot(points[i].x, points[i].y, points[i].z) -
                         std::hypot(truth[i].x, truth[i].y, truth[i].z);
    squares += error * error;
  }
  const auto count = static_cast<double>(points.size());
  EXPECT_NEAR(std::sqrt(squares / count), 0.03, 4.0 * 0.03 / std::sqrt(2.0 * count));
  options.dropout = 0.2;
  const SimulatedDrive gaps(campus(), campus_scene(), few_frames(2), 1, small_stereo(), options);
  EXPECT_NEAR(static_cast<double>(gaps.lidar(0).points.size()) / count, 0.8,
              4.0 * std::sqrt(0.16 / count));
}

TEST(SimulatedDrive, SweepMovesWithTheRobot) {
  LidarOptions options;
  options.rings = 8;
  options.columns = 180;
  options.range_noise_m = options.dropout = 0.0;
  options.camera = false;
  options.sweep_s = 0.1;
  const SimulatedDrive drive(campus(), campus_scene(), few_frames(3), 1, small_stereo(), options);
  const double step = drive.stamp(1).seconds() - drive.stamp(0).seconds();
  double latest = 0.0;
  std::size_t off = 0;
  for (const LidarPoint& point : drive.lidar(0).points) {
    // Undone by its own time offset, each point lies on the surface again.
    const auto& a = drive.map_from_robot(0);
    const auto& b = drive.map_from_robot(1);
    const double share = point.time_offset_s / step;
    auto robot = a;
    robot.rotation = a.rotation.slerp(share, b.rotation);
    robot.translation += share * (b.translation - a.translation);
    const auto lidar = robot * drive.lidar_rig().robot_from_lidar;
    const auto origin = Point3<frames::Map>::from(lidar.translation);
    const auto near =
        lidar * Point3<frames::Lidar>{0.995 * point.x, 0.995 * point.y, 0.995 * point.z};
    const auto beyond =
        lidar * Point3<frames::Lidar>{1.005 * point.x, 1.005 * point.y, 1.005 * point.z};
    if (!campus_scene().sees(origin, near) || campus_scene().sees(origin, beyond)) ++off;
    latest = std::max(latest, static_cast<double>(point.time_offset_s));
  }
  EXPECT_LT(off, drive.lidar(0).points.size() / 50);  // leaves, as above
  EXPECT_GT(latest, 0.05);
  EXPECT_LT(latest, 0.1);
}

TEST(SimulatedDrive, RobotStandsOnTheGroundAndKeepsToItsLane) {
  RouteOptions route;
  route.shake_deg = 0.0;
  const SimulatedDrive drive(campus(), campus_scene(), route, 1, small_stereo());
  double length = 0.0;
  double turned = 0.0;
  for (int i = 0; i < drive.size(); ++i) {
    const auto& pose = drive.map_from_robot(i);
    const Pose2 at = planar(pose);
    EXPECT_NEAR(pose.translation.z(), campus().ground_height(at.x, at.y), 0.03);
    const Eigen::Vector3d up = pose.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT(std::acos(std::min(up.z(), 1.0)), radians(8.0));
    if (i == 0) continue;
    const Pose2 before = planar(drive.map_from_robot(i - 1));
    length += std::hypot(at.x - before.x, at.y - before.y);
    turned += std::abs(wrap_angle(at.yaw - before.yaw));
    EXPECT_LT(std::abs(wrap_angle(at.yaw - before.yaw)), radians(15.0));
    EXPECT_GT(drive.stamp(i), drive.stamp(i - 1));
  }
  EXPECT_GT(length, 80.0);
  EXPECT_GT(turned, radians(150.0));  // two corners and the bends between them
}

/// Where the odometry ends, in the robot's true frame at the start.
Motion2 odometry_end(const RouteOptions& route, std::uint64_t seed) {
  const SimulatedDrive drive(campus(), campus_scene(), route, seed, small_stereo());
  const OdomPose2 first = planar(drive.odom_from_robot(0));
  const OdomPose2 last = planar(drive.odom_from_robot(drive.size() - 1));
  const auto moved = first.inverse() * last;
  return {moved.x, moved.y, moved.yaw};
}

TEST(SimulatedDrive, OdometryWithoutErrorsIsTheTruth) {
  RouteOptions route = few_frames(60);
  route.odometry_scale = route.odometry_noise = 0.0;
  route.odometry_yaw_deg_per_m = route.odometry_yaw_noise_deg = 0.0;
  const SimulatedDrive drive(campus(), campus_scene(), route, 1, small_stereo());
  const auto map_from_odom = drive.map_from_robot(0) * drive.odom_from_robot(0).inverse();
  for (int i = 0; i < drive.size(); ++i) {
    const auto expected = drive.map_from_robot(i);
    const auto pose = map_from_odom * drive.odom_from_robot(i);
    EXPECT_LT((pose.translation - expected.translation).norm(), 1e-6);
    EXPECT_LT(pose.rotation.angularDistance(expected.rotation), 1e-6);
  }
}

TEST(SimulatedDrive, OdometryDriftsAsAskedFor) {
  RouteOptions exact = few_frames(40);
  exact.odometry_scale = exact.odometry_noise = 0.0;
  exact.odometry_yaw_deg_per_m = exact.odometry_yaw_noise_deg = 0.0;
  const Motion2 truth = odometry_end(exact, 1);
  RouteOptions scaled = exact;
  scaled.odometry_scale = -0.05;
  EXPECT_NEAR(std::hypot(odometry_end(scaled, 1).x, odometry_end(scaled, 1).y),
              0.95 * std::hypot(truth.x, truth.y), 1e-6);
  RouteOptions turning = exact;
  turning.odometry_yaw_deg_per_m = 0.1;
  EXPECT_NEAR(odometry_end(turning, 1).yaw - truth.yaw, radians(0.1 * 39 * 0.8), radians(0.05));

  RouteOptions noisy = exact;
  noisy.odometry_noise = 0.02;
  double squares = 0.0;
  constexpr int kDrives = 40;
  for (int seed = 1; seed <= kDrives; ++seed) {
    const Motion2 end = odometry_end(noisy, static_cast<std::uint64_t>(seed));
    squares += (std::pow(end.x - truth.x, 2.0) + std::pow(end.y - truth.y, 2.0)) / (2.0 * kDrives);
  }
  // Random steps of 2 cm per root metre over 31.2 m; 80 squares.
  const double expected = 0.02 * std::sqrt(31.2);
  EXPECT_NEAR(std::sqrt(squares), expected, 4.0 * expected * 0.5 * std::sqrt(2.0 / 80.0));
}

TEST(SimulatedDrive, TrueLocalMapIsTheOrthomosaicAroundTheRobot) {
  const SimulatedDrive drive(campus(), campus_scene(), few_frames(40), 1, small_stereo());
  LocalTruthOptions options;
  options.only_seen = false;
  options.ceiling_m = 500.0;
  const Frame frame = drive.true_local(30, options);
  const Pose2 pose = planar(drive.map_from_robot(30));
  const double floor = drive.map_from_robot(30).translation.z();
  ASSERT_EQ(frame.local.width(), 180);
  EXPECT_DOUBLE_EQ(frame.local.geo.x_at(90.0), 0.0);
  std::vector<double> local;
  std::vector<double> map;
  for (int row = 3; row < 180; row += 7) {
    for (int column = 3; column < 180; column += 7) {
      const auto p = pose * Point2<frames::Robot>{frame.local.geo.x_at(column + 0.5),
                                                  frame.local.geo.y_at(row + 0.5)};
      const Orthomosaic pixel =
          campus_scene().true_orthomosaic({p.x - 0.05, p.y + 0.05, 0.1, {}}, 1, 1);
      local.push_back(frame.local.image.at(column, row, 1));
      map.push_back(pixel.image.at(0, 0, 1));
      EXPECT_NEAR(frame.elevation->height_m.at(column, row),
                  campus_scene().surface_height(p.x, p.y) - floor, 2e-3);
    }
  }
  EXPECT_GT(test::zncc(local, map), 0.95);
}

TEST(SimulatedDrive, LocalMapHoldsWhatTheCamerasSaw) {
  const SimulatedDrive drive(campus(), campus_scene(), few_frames(40), 1, small_stereo());
  const auto share_of = [&](int number) {
    const Frame frame = drive.true_local(number, {});
    double seen = 0.0;
    for (std::size_t i = 0; i < frame.local.valid.values().size(); ++i) {
      const bool valid = frame.local.valid.values()[i] != 0;
      EXPECT_EQ(valid, std::isfinite(frame.elevation->height_m.values()[i]));
      if (valid) seen += 1.0;
    }
    return seen / static_cast<double>(frame.local.valid.values().size());
  };
  const double first = share_of(0);
  const double later = share_of(35);
  EXPECT_GT(first, 0.02);
  EXPECT_LT(first, 0.5);  // the first frame sees ahead only
  EXPECT_GT(later, first + 0.2);
}

TEST(SimulatedDrive, SensorsAreTheSameForAnyNumberOfThreads) {
  LidarOptions lidar;
  lidar.rings = 8;
  lidar.columns = 90;
  const auto sensed = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const SimulatedDrive drive(campus(), campus().seen(drive_appearance()), few_frames(3), 1,
                               small_stereo(), lidar);
    const StereoFrame pair = drive.stereo(2);
    const LidarFrame scan = drive.lidar(2);
    std::vector<float> numbers;
    for (const LidarPoint& point : scan.points) {
      numbers.insert(numbers.end(), {point.x, point.y, point.z, point.intensity});
    }
    return std::tuple{pair.left, pair.right, scan.images.at(0), numbers,
                      drive.true_local(2, {}).local.image};
  };
  EXPECT_EQ(sensed(1), sensed(4));
}

TEST(SimulatedDrive, RefusesRoutesThatAreNotThere) {
  RouteOptions route;
  route.route = 7;
  EXPECT_THROW(SimulatedDrive(campus(), campus_scene(), route, 1), Error);
  route.route = 0;
  route.frames = 4000;
  EXPECT_THROW(SimulatedDrive(campus(), campus_scene(), route, 1), Error);
}

}  // namespace
}  // namespace nadir
