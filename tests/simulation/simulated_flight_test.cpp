// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_flight.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/simulation/scene/terrain.hpp"
#include "simulation/dotted_world.hpp"
#include "simulation/small_world.hpp"

namespace nadir {
namespace {

using test::campus;

FlightOptions perfect_camera() {
  FlightOptions options;
  options.height_m = 30.0;
  options.image_width = 400;
  options.image_height = 300;
  options.focal_px = 330.0;
  options.k1 = -0.06;
  options.k2 = 0.02;
  options.tilt_deg = 2.0;
  options.readout_s = 0.0;
  options.vignetting = options.blur_px = options.noise_grey = 0.0;
  options.exposure_drift = options.white_balance_drift = 0.0;
  return options;
}

Appearance without_traffic() {
  Appearance appearance = flight_appearance();
  appearance.cars_per_km = 0.0;
  return appearance;
}

/// Errors between the dots of a photo and where the camera model says they are.
std::vector<Eigen::Vector2d> dot_errors(const SimulatedFlight& flight, int number,
                                        const std::vector<Eigen::Vector3d>& dots) {
  const PhotoPose pose = flight.truth(number);
  const Raster<std::uint8_t> image = flight.render(number).image;
  std::vector<Eigen::Vector2d> errors;
  for (const Eigen::Vector3d& dot : dots) {
    const auto in_camera = pose.map_from_camera.inverse() * Point3<frames::Map>::from(dot);
    const auto pixel = pose.camera.project(in_camera.vector());
    if (!pixel || pixel->x() < 12 || pixel->y() < 12 || pixel->x() > pose.camera.width - 13 ||
        pixel->y() > pose.camera.height - 13) {
      continue;
    }
    errors.emplace_back(test::centre_of_light(image, *pixel, 9.0) - *pixel);
  }
  return errors;
}

TEST(SimulatedFlight, DotsAppearWhereTheCameraModelSays) {
  const test::DottedWorld dotted = test::dotted_world(3.0, 0.2, 0.05);
  const SimulatedFlight flight(dotted.world, dotted.world.seen(without_traffic()), perfect_camera(),
                               5);
  const auto errors = dot_errors(flight, flight.size() / 2, dotted.dots);
  ASSERT_GE(errors.size(), 60U);
  for (const Eigen::Vector2d& error : errors) EXPECT_LT(error.norm(), 0.1);
}

TEST(SimulatedFlight, RollingShutterShiftsRowsByTheWayFlown) {
  const test::DottedWorld dotted = test::dotted_world(3.0, 0.2, 0.05);
  FlightOptions options = perfect_camera();
  options.tilt_deg = 0.0;
  options.readout_s = 0.1;
  options.speed_m_s = 10.0;  // 1 m while the photo is read: 330 / 27 = 12 px from edge to edge
  const SimulatedFlight flight(dotted.world, dotted.world.seen(without_traffic()), options, 5);
  const int number = flight.size() / 2;
  const PhotoPose pose = flight.truth(number);
  const Raster<std::uint8_t> image = flight.render(number).image;
  const Eigen::Vector3d v = flight.velocity(number);
  int checked = 0;
  for (const Eigen::Vector3d& dot : dotted.dots) {
    // The row at which a dot is read decides where the camera was: a fixed point.
    double row = 0.5 * options.image_height;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
    for (int i = 0; i < 20; ++i) {
      auto at = pose.map_from_camera;
      at.translation += ((row + 0.5) / options.image_height - 0.5) * options.readout_s * v;
      pixel = *pose.camera.project((at.inverse() * Point3<frames::Map>::from(dot)).vector());
      row = pixel.y();
    }
    if (pixel.x() < 12 || pixel.y() < 12 || pixel.x() > options.image_width - 13 ||
        pixel.y() > options.image_height - 13) {
      continue;
    }
    EXPECT_LT((test::centre_of_light(image, pixel, 9.0) - pixel).norm(), 0.15);
    ++checked;
  }
  EXPECT_GE(checked, 60);
}

TEST(SimulatedFlight, PhotosWarpedBackAreTheTrueOrthomosaic) {
  const SimulatedScene scene = campus().seen(without_traffic());
  FlightOptions options = perfect_camera();
  options.image_width = 800;
  options.image_height = 600;
  options.focal_px = 660.0;
  const SimulatedFlight flight(campus(), scene, options, 2);
  const int number = flight.size() / 2;
  const PhotoPose pose = flight.truth(number);
  const Raster<std::uint8_t> image = flight.render(number).image;
  const Eigen::Vector3d& eye = pose.map_from_camera.translation;
  const GeoReference geo{eye.x() - 10.0, eye.y() + 8.0, 0.1, {}};
  const Orthomosaic map = scene.true_orthomosaic(geo, 200, 160);
  const ElevationMap surface = scene.true_surface(geo, 200, 160);
  std::vector<double> expected;
  std::vector<double> warped;
  for (int row = 0; row < 160; ++row) {
    for (int column = 0; column < 200; ++column) {
      const Eigen::Vector3d p(geo.x_at(column + 0.5), geo.y_at(row + 0.5),
                              surface.height_m.at(column, row));
      if (!scene.sees(Point3<frames::Map>::from(eye),
                      Point3<frames::Map>::from(p + Eigen::Vector3d(0, 0, 0.03)))) {
        continue;
      }
      const auto pixel = pose.camera.project(
          (pose.map_from_camera.inverse() * Point3<frames::Map>::from(p)).vector());
      const int u = static_cast<int>(pixel->x());
      const int v = static_cast<int>(pixel->y());
      if (u < 0 || v < 0 || u + 1 >= image.width() || v + 1 >= image.height()) continue;
      const double a = pixel->x() - u;
      const double b = pixel->y() - v;
      warped.push_back((1 - b) * ((1 - a) * image.at(u, v, 1) + a * image.at(u + 1, v, 1)) +
                       b * ((1 - a) * image.at(u, v + 1, 1) + a * image.at(u + 1, v + 1, 1)));
      expected.push_back(map.image.at(column, row, 1));
    }
  }
  ASSERT_GT(expected.size(), 20000U);
  EXPECT_GT(test::zncc(expected, warped), 0.97);
}

TEST(SimulatedFlight, ShadowsFallAwayFromTheSun) {
  // The same place, two metres from a wall, with the sun before and behind the house.
  Appearance appearance = without_traffic();
  appearance.sun_elevation_deg = 45.0;
  int places = 0;
  int darker = 0;
  for (const double heading : {0.0, 90.0, 180.0, 270.0}) {
    appearance.sun_heading_deg = heading;
    const SimulatedScene before = campus().seen(appearance);
    appearance.sun_heading_deg = heading + 180.0;
    const SimulatedScene behind = campus().seen(appearance);
    const Eigen::Vector2d towards(std::sin(radians(heading)), std::cos(radians(heading)));
    for (const simulation::Building& building : campus().terrain()->layout.buildings) {
      const simulation::Area& plan = building.plan;
      const bool east = std::abs(towards.x()) > 0.5;
      const double out = (east ? plan.half_length : plan.half_width) + 2.0;
      const double along = east ? plan.half_width : plan.half_length;
      for (const double share : {-0.6, -0.3, 0.0, 0.3, 0.6}) {
        const Eigen::Vector2d p = plan.centre + out * towards +
                                  share * along * Eigen::Vector2d(-towards.y(), towards.x());
        if (p.minCoeff() < 0.0 || p.x() > campus().width_m() || p.y() > campus().depth_m()) {
          continue;
        }
        const auto mean_of = [&](const SimulatedScene& scene) {
          const Orthomosaic map = scene.true_orthomosaic({p.x() - 0.5, p.y() + 0.5, 0.2, {}}, 5, 5);
          double sum = 0.0;
          for (const std::uint8_t value : map.image.values()) sum += value;
          return sum;
        };
        const double ratio = mean_of(before) / mean_of(behind);
        ++places;
        if (ratio > 1.3) ++darker;
        EXPECT_GT(ratio, 0.8) << p.transpose();  // crowns show their lit side from above
      }
    }
  }
  EXPECT_GE(places, 50);
  EXPECT_GE(darker, 0.5 * places);  // trees and the house opposite shade the rest
}

TEST(SimulatedFlight, PlanHasTheOverlapsAskedFor) {
  FlightOptions options;
  options.forward_overlap = 0.8;
  options.side_overlap = 0.6;
  options.height_m = 40.0;
  const FlightPlan plan = plan_flight(campus(), options);
  const double along = options.height_m * options.image_height / options.focal_px;
  const double across = options.height_m * options.image_width / options.focal_px;
  int pairs = 0;
  std::vector<double> lines;
  for (std::size_t i = 1; i < plan.waypoints.size(); ++i) {
    const auto& a = plan.waypoints[i - 1];
    const auto& b = plan.waypoints[i];
    EXPECT_GT(b.stamp, a.stamp);
    const double step = std::hypot(b.position.x - a.position.x, b.position.y - a.position.y);
    if (std::abs(a.position.y - b.position.y) < 1e-9) {  // the site is wider than it is deep
      EXPECT_NEAR(1.0 - step / along, options.forward_overlap, 1e-9);
      ++pairs;
    } else {
      EXPECT_NEAR(1.0 - step / across, options.side_overlap, 1e-9);
    }
  }
  EXPECT_GT(pairs, 10);
  // Every corner of the site lies well within a photo.
  for (const double x : {0.0, campus().width_m()}) {
    for (const double y : {0.0, campus().depth_m()}) {
      int seen = 0;
      for (const auto& waypoint : plan.waypoints) {
        if (std::abs(waypoint.position.x - x) < 0.5 * along &&
            std::abs(waypoint.position.y - y) < 0.5 * across) {
          ++seen;
        }
      }
      EXPECT_GE(seen, 1);
    }
  }
}

struct GpsErrors {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();
  int count = 0;
};

/// Tagged minus true positions, metres.
GpsErrors gps_errors(const SimulatedFlight& flight, const SiteAnchor& anchor) {
  std::vector<Eigen::Vector3d> errors;
  GpsErrors result;
  for (int i = 0; i < flight.size(); ++i) {
    const auto place = Point3<frames::Map>::from(flight.truth(i).map_from_camera.translation);
    const GeodeticPosition truth = anchor.geodetic(place);
    const GeodeticPosition tagged = *flight.metadata(i).position;
    const double to_metres = radians(1.0) * 6378137.0;
    errors.emplace_back((tagged.longitude_deg - truth.longitude_deg) * to_metres *
                            std::cos(radians(truth.latitude_deg)),
                        (tagged.latitude_deg - truth.latitude_deg) * to_metres,
                        tagged.altitude_m - truth.altitude_m);
    result.mean += errors.back();
  }
  result.count = flight.size();
  result.mean /= result.count;
  for (const Eigen::Vector3d& error : errors) {
    result.deviation += (error - result.mean).cwiseAbs2() / (result.count - 1);
  }
  result.deviation = result.deviation.cwiseSqrt();
  return result;
}

TEST(SimulatedFlight, PositionsHaveTheErrorsAskedFor) {
  const SimulatedScene scene = campus().seen(without_traffic());
  FlightOptions options = perfect_camera();
  options.forward_overlap = 0.95;
  options.side_overlap = 0.9;
  options.rtk = true;
  options.rtk_sigma_m = 0.02;
  const SimulatedFlight rtk(campus(), scene, options, 4);
  ASSERT_GT(rtk.size(), 300);
  const double few = std::sqrt(static_cast<double>(rtk.size()));
  const GpsErrors good = gps_errors(rtk, campus().anchor());
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_NEAR(good.mean[axis], 0.0, 4.0 * 0.02 / few);
    EXPECT_NEAR(good.deviation[axis], 0.02, 4.0 * 0.02 / few);
  }
  EXPECT_NEAR(good.deviation.z(), 0.03, 4.0 * 0.03 / few);
  EXPECT_DOUBLE_EQ(rtk.metadata(0).position->horizontal_sigma_m.value(), 0.02);

  options.rtk = false;
  options.gps_noise_m = 0.3;
  options.gps_bias_m = 1.5;
  double squares = 0.0;
  constexpr int kFlights = 24;
  for (int seed = 0; seed < kFlights; ++seed) {
    const SimulatedFlight flight(campus(), scene, options, static_cast<std::uint64_t>(seed));
    const GpsErrors errors = gps_errors(flight, campus().anchor());
    squares += errors.mean.head<2>().squaredNorm() / (2.0 * kFlights);
    EXPECT_NEAR(errors.deviation.x(), 0.3, 5.0 * 0.3 / few);
    EXPECT_FALSE(flight.metadata(0).position->horizontal_sigma_m.has_value());
  }
  // 48 squares of standard normal numbers: within 4 standard deviations of their mean.
  EXPECT_NEAR(std::sqrt(squares), 1.5, 1.5 * 4.0 * 0.5 * std::sqrt(2.0 / 48.0));
}

TEST(SimulatedFlight, LagTagsWhereTheDroneWas) {
  const SimulatedScene scene = campus().seen(without_traffic());
  FlightOptions options = perfect_camera();
  options.rtk = true;
  options.rtk_sigma_m = 0.0;
  options.gps_lag_s = 0.2;
  options.speed_m_s = 5.0;
  const SimulatedFlight flight(campus(), scene, options, 4);
  const SiteAnchor& anchor = campus().anchor();
  const auto true_place = flight.truth(0).map_from_camera.translation;
  const GeodeticPosition tagged = *flight.metadata(0).position;
  const Eigen::Vector3d behind = true_place - 0.2 * flight.velocity(0);
  const GeodeticPosition expected = anchor.geodetic(Point3<frames::Map>::from(behind));
  EXPECT_NEAR(tagged.latitude_deg, expected.latitude_deg, 1e-10);
  EXPECT_NEAR(tagged.longitude_deg, expected.longitude_deg, 1e-10);
  EXPECT_NEAR((behind - true_place).norm(), 1.0, 1e-9);
}

TEST(SimulatedFlight, GimbalSaysTheHeadingFromTrueNorth) {
  FlightOptions options = perfect_camera();
  options.compass_bias_deg = options.compass_noise_deg = 0.0;
  options.tilt_deg = 0.0;
  const SimulatedFlight flight(campus(), campus().seen(without_traffic()), options, 4);
  for (int i = 0; i < flight.size(); i += 3) {
    const PhotoPose pose = flight.truth(i);
    const Eigen::Vector3d& eye = pose.map_from_camera.translation;
    const Eigen::Vector3d ahead =
        eye - 100.0 * (pose.map_from_camera.rotation * Eigen::Vector3d::UnitY());
    const GeodeticPosition here = campus().anchor().geodetic(Point3<frames::Map>::from(eye));
    const GeodeticPosition there = campus().anchor().geodetic(Point3<frames::Map>::from(ahead));
    // The meridian's and the parallel's radius differ by 0.4 % at this latitude.
    const double north = (there.latitude_deg - here.latitude_deg) * 0.9961;
    const double east =
        (there.longitude_deg - here.longitude_deg) * std::cos(radians(here.latitude_deg));
    const double heading = degrees(std::atan2(east, north));
    EXPECT_NEAR(std::remainder(flight.metadata(i).gimbal->yaw_deg - heading, 360.0), 0.0, 0.1);
    EXPECT_NEAR(flight.metadata(i).gimbal->pitch_deg, -90.0, 0.5);
  }
}

TEST(SimulatedFlight, PhotosAreTheSameForAnyNumberOfThreads) {
  FlightOptions options;
  options.image_width = 160;
  options.image_height = 120;
  options.focal_px = 125.0;
  const SimulatedFlight flight(campus(), campus().seen(flight_appearance()), options, 4);
  const auto bytes = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return flight.render(2).image;
  };
  EXPECT_EQ(bytes(1), bytes(4));
  EXPECT_NE(flight.render(3).image, bytes(1));
}

}  // namespace
}  // namespace nadir
