// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir {
namespace {

TEST(SiteAnchor, AgreesWithProj) {
  // gdaltransform -s_srs EPSG:32632 -t_srs EPSG:4326 (GDAL 3.6.2, PROJ 9.1.1)
  const SiteAnchor anchor;
  const GeodeticPosition origin = anchor.geodetic({0.0, 0.0, 2.5});
  EXPECT_NEAR(origin.latitude_deg, 49.625707284598, 1e-10);  // 1e-10 degree = 0.01 mm
  EXPECT_NEAR(origin.longitude_deg, 6.50755648912667, 1e-10);
  EXPECT_DOUBLE_EQ(origin.altitude_m, anchor.altitude_m + 2.5);
  const GeodeticPosition corner = anchor.geodetic({120.0, 90.0, 0.0});
  EXPECT_NEAR(corner.latitude_deg, 49.6265517835622, 1e-10);
  EXPECT_NEAR(corner.longitude_deg, 6.50917520329118, 1e-10);
}

TEST(SiteAnchor, AgreesWithProjInTheSouth) {
  // gdaltransform -s_srs EPSG:32733 -t_srs EPSG:4326
  SiteAnchor anchor;
  anchor.easting_m = 700000.0;
  anchor.northing_m = 6200000.0;
  anchor.utm_zone = -33;
  const GeodeticPosition origin = anchor.geodetic({0.0, 0.0, 0.0});
  EXPECT_NEAR(origin.latitude_deg, -34.3220050521924, 1e-10);
  EXPECT_NEAR(origin.longitude_deg, 17.17377076157, 1e-10);
  const GeodeticPosition corner = anchor.geodetic({120.0, 90.0, 0.0});
  EXPECT_NEAR(corner.latitude_deg, -34.3211708265342, 1e-10);
  EXPECT_NEAR(corner.longitude_deg, 17.1750532621116, 1e-10);
  // East of the central meridian the grid's north leans to the west of true north in the south.
  EXPECT_NEAR(degrees(anchor.convergence({0.0, 0.0, 0.0})), -1.2262, 1e-3);
}

TEST(SiteAnchor, IsTrueToScale) {
  // A kilometre of the grid, as metres along the meridian and the parallel.
  const SiteAnchor anchor;
  const GeodeticPosition south = anchor.geodetic({0.0, 0.0, 0.0});
  const GeodeticPosition north = anchor.geodetic({0.0, 1000.0, 0.0});
  constexpr double kSemiMajor = 6378137.0;
  constexpr double kE2 = 0.00669437999014;
  const double latitude = radians(0.5 * (south.latitude_deg + north.latitude_deg));
  const double w2 = 1.0 - kE2 * std::sin(latitude) * std::sin(latitude);
  const double n = kSemiMajor / std::sqrt(w2);
  const double dy = radians(north.latitude_deg - south.latitude_deg) * n * (1.0 - kE2) / w2;
  const double dx = radians(north.longitude_deg - south.longitude_deg) * n * std::cos(latitude);
  EXPECT_NEAR(std::hypot(dx, dy), 1000.0, 3e-3);
  // Grid north leans by the same angle that those two places say.
  EXPECT_NEAR(anchor.convergence({0.0, 500.0, 0.0}), std::atan2(dx, dy), 1e-6);
}

}  // namespace
}  // namespace nadir
