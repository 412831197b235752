// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/drive.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

DriveOptions few_frames() {
  DriveOptions options;
  options.frames = 4;
  return options;
}

DriveOptions perfect_sensor() {
  DriveOptions options = few_frames();
  options.hole_share = 0.0;
  options.noise_grey = 0.0;
  options.blur_px = 0.0;
  options.exposure_gain = 1.0;
  options.exposure_gamma = 1.0;
  options.unseen_cars = 0;
  return options;
}

/// Bilinear value of the map at a place; NaN where a pixel needed is outside or invalid.
double map_value(const Orthomosaic& map, Point2<frames::Map> point, int channel) {
  const PixelCoordinate pixel = map.geo.pixel_at(point.x, point.y);
  const double column = std::floor(pixel.column - 0.5);
  const double row = std::floor(pixel.row - 0.5);
  double sum = 0.0;
  for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
    const int c = static_cast<int>(column) + dx;
    const int r = static_cast<int>(row) + dy;
    if (!map.image.contains(c, r) || map.valid.at(c, r) == 0) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    const double u = pixel.column - 0.5 - column;
    const double v = pixel.row - 0.5 - row;
    sum += (dx == 1 ? u : 1.0 - u) * (dy == 1 ? v : 1.0 - v) * map.image.at(c, r, channel);
  }
  return sum;
}

double hole_share(const Orthomosaic& local) {
  const auto& valid = local.valid.values();
  return static_cast<double>(std::count(valid.begin(), valid.end(), 0)) /
         static_cast<double>(valid.size());
}

double path_length(const std::vector<Frame>& frames) {
  double length = 0.0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    length += std::hypot(frames[i].odom_from_robot->x - frames[i - 1].odom_from_robot->x,
                         frames[i].odom_from_robot->y - frames[i - 1].odom_from_robot->y);
  }
  return length;
}

double path_length(const Trajectory& truth) {
  double length = 0.0;
  for (std::size_t i = 1; i < truth.size(); ++i) {
    length +=
        std::hypot(truth[i].pose.x - truth[i - 1].pose.x, truth[i].pose.y - truth[i - 1].pose.y);
  }
  return length;
}

void expect_equal(const Orthomosaic& a, const Orthomosaic& b) {
  EXPECT_EQ(a.image, b.image);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_EQ(a.geo, b.geo);
}

TEST(SimulateDrive, SameSeedSameBytes) {
  const SimulatedSite a = simulate_drive(5, few_frames());
  const SimulatedSite b = simulate_drive(5, few_frames());
  expect_equal(a.map, b.map);
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    expect_equal(a.frames[i].local, b.frames[i].local);
    EXPECT_EQ(a.frames[i].odom_from_robot->x, b.frames[i].odom_from_robot->x);
    EXPECT_EQ(a.frames[i].odom_from_robot->yaw, b.frames[i].odom_from_robot->yaw);
    EXPECT_EQ(a.truth[i].pose.x, b.truth[i].pose.x);
  }
}

TEST(SimulateDrive, AnotherSeedIsAnotherPlace) {
  const SimulatedSite a = simulate_drive(5, few_frames());
  const SimulatedSite b = simulate_drive(6, few_frames());
  EXPECT_NE(a.map.image, b.map.image);
  EXPECT_NE(a.map.valid, b.map.valid);
  EXPECT_NE(a.frames[0].local.valid, b.frames[0].local.valid);
}

TEST(SimulateDrive, PerfectSensorSeesTheMapAtTheTruth) {
  const SimulatedSite site = simulate_drive(7, perfect_sensor());
  for (std::size_t i = 0; i < site.frames.size(); ++i) {
    const Orthomosaic& local = site.frames[i].local;
    double sum = 0.0;
    int count = 0;
    for (int row = 0; row < local.height(); ++row) {
      for (int column = 0; column < local.width(); ++column) {
        const Point2<frames::Robot> in_robot{local.geo.x_at(column + 0.5),
                                             local.geo.y_at(row + 0.5)};
        const double wanted = map_value(site.map, site.truth[i].pose * in_robot, 1);
        if (std::isnan(wanted)) continue;
        ASSERT_NE(local.valid.at(column, row), 0);
        sum += std::abs(wanted - local.image.at(column, row, 1));
        ++count;
      }
    }
    EXPECT_GT(count, local.width() * local.height() / 2);
    EXPECT_LT(sum / count, 0.3);  // rounding alone is 0.25
  }
}

TEST(SimulateDrive, RobotSitsInTheMiddleAndLooksToTheRight) {
  const SimulatedSite site = simulate_drive(7, few_frames());
  const Orthomosaic& local = site.frames[0].local;
  EXPECT_EQ(local.width(), 180);
  EXPECT_EQ(local.image.channels(), 3);
  EXPECT_DOUBLE_EQ(local.geo.x_at(0.5 * local.width()), 0.0);
  EXPECT_DOUBLE_EQ(local.geo.y_at(0.5 * local.height()), 0.0);
}

TEST(SimulateDrive, TruthLooksAlongItsOwnPath) {
  const SimulatedSite site = simulate_drive(9, few_frames());
  for (std::size_t i = 1; i < site.truth.size(); ++i) {
    const Pose2& from = site.truth[i - 1].pose;
    const Pose2& to = site.truth[i].pose;
    EXPECT_NEAR(std::hypot(to.x - from.x, to.y - from.y), 0.8, 0.05);
    EXPECT_NEAR(std::atan2(to.y - from.y, to.x - from.x), 0.5 * (from.yaw + to.yaw), 0.01);
    EXPECT_LT(site.truth[i - 1].stamp, site.truth[i].stamp);
    EXPECT_EQ(site.frames[i].stamp, site.truth[i].stamp);
  }
}

TEST(SimulateDrive, HolesAreAsManyAsAsked) {
  for (const double share : {0.0, 0.3, 0.7}) {
    DriveOptions options = few_frames();
    options.hole_share = share;
    for (const Frame& frame : simulate_drive(3, options).frames) {
      EXPECT_NEAR(hole_share(frame.local), share, 0.01);
    }
  }
}

TEST(SimulateDrive, OdometryFallsShortByTheDrift) {
  DriveOptions options;
  options.local_size_m = 2.0;
  for (const double drift : {-0.05, 0.1}) {
    options.odometry_drift = drift;
    const SimulatedSite site = simulate_drive(4, options);
    EXPECT_NEAR(path_length(site.frames) / path_length(site.truth), 1.0 - drift, 0.006);
    EXPECT_EQ(site.frames[0].odom_from_robot->x, 0.0);
    EXPECT_EQ(site.frames[0].odom_from_robot->yaw, 0.0);
  }
}

TEST(SimulateDrive, ExposureChangesTheGreyButNotTheTruth) {
  DriveOptions options = perfect_sensor();
  const SimulatedSite bright = simulate_drive(8, options);
  options.exposure_gain = 0.5;
  const SimulatedSite dark = simulate_drive(8, options);
  EXPECT_EQ(bright.map.image, dark.map.image);
  const auto mean = [](const Orthomosaic& local) {
    double sum = 0.0;
    for (const std::uint8_t value : local.image.values()) sum += value;
    return sum / static_cast<double>(local.image.values().size());
  };
  EXPECT_NEAR(mean(dark.frames[0].local) / mean(bright.frames[0].local), 0.5, 0.01);
}

TEST(SimulateDrive, UnseenCarsAreInTheFramesOnly) {
  DriveOptions options = perfect_sensor();
  const SimulatedSite without = simulate_drive(8, options);
  options.unseen_cars = 3;
  const SimulatedSite with = simulate_drive(8, options);
  EXPECT_EQ(with.map.image, without.map.image);
  EXPECT_NE(with.frames[2].local.image, without.frames[2].local.image);
}

TEST(SimulateDrive, EveryNumberIsFinite) {
  const SimulatedSite site = simulate_drive(10, few_frames());
  for (std::size_t i = 0; i < site.truth.size(); ++i) {
    EXPECT_TRUE(site.truth[i].pose.is_finite());
    EXPECT_TRUE(site.frames[i].odom_from_robot->is_finite());
  }
}

TEST(SimulateDrive, MapHasARaggedInvalidBorder) {
  const Orthomosaic map = simulate_drive(1, few_frames()).map;
  EXPECT_EQ(map.width(), 1200);
  EXPECT_EQ(map.height(), 600);
  const double invalid = hole_share(map);
  EXPECT_GT(invalid, 0.01);
  EXPECT_LT(invalid, 0.12);
  EXPECT_EQ(map.valid.at(0, 0), 0);
  EXPECT_NE(map.valid.at(600, 300), 0);
}

TEST(SimulateDrive, LongDriveGetsALongerMap) {
  DriveOptions options = few_frames();
  options.frames = 12;
  options.step_m = 10.0;
  options.local_size_m = 20.0;
  const SimulatedSite site = simulate_drive(2, options);
  EXPECT_EQ(site.map.width(), 1700);
  for (const Frame& frame : site.frames) EXPECT_NEAR(hole_share(frame.local), 0.3, 0.01);
}

TEST(SimulateDrive, OptionOutOfRangeIsAUsageError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto fails = [](auto change) {
    DriveOptions options;
    change(options);
    try {
      simulate_drive(1, options);
    } catch (const Error& error) {
      return error.kind() == ErrorKind::kUsage;
    }
    return false;
  };
  EXPECT_TRUE(fails([](DriveOptions& o) { o.frames = 0; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.step_m = -1.0; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.step_m = 15.0; }));  // 900 m in all
  EXPECT_TRUE(fails([](DriveOptions& o) { o.local_size_m = 0.0; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.local_resolution_m = 0.0; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.hole_share = 1.0; }));
  EXPECT_TRUE(fails([nan](DriveOptions& o) { o.noise_grey = nan; }));
  EXPECT_TRUE(fails([nan](DriveOptions& o) { o.blur_px = nan; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.exposure_gain = 0.0; }));
  EXPECT_TRUE(fails([nan](DriveOptions& o) { o.odometry_drift = nan; }));
  EXPECT_TRUE(fails([](DriveOptions& o) { o.unseen_cars = -1; }));
}

}  // namespace
}  // namespace nadir
