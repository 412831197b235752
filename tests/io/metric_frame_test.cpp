// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/metric_frame.hpp"

#include <gtest/gtest.h>

#include "io/gdal_files.hpp"
#include "nadir/core/angle.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;

GeodeticPosition at(double latitude, double longitude, double altitude = 0.0) {
  return GeodeticPosition{latitude, longitude, altitude};
}

TEST(Heading, IsTheYawOnTheCompass) {
  EXPECT_NEAR(yaw_of_heading(radians(0.0)), radians(90.0), 1e-15);
  EXPECT_NEAR(yaw_of_heading(radians(90.0)), 0.0, 1e-15);
  EXPECT_NEAR(yaw_of_heading(radians(180.0)), radians(-90.0), 1e-15);
  EXPECT_NEAR(yaw_of_heading(radians(270.0)), radians(180.0), 1e-15);
}

TEST(MetricFrame, TakesTheZoneOfTheMedianPosition) {
  EXPECT_EQ(MetricFrame::around({at(46.84, -91.99)}).name(), "EPSG:32615 (UTM zone 15 north)");
  EXPECT_EQ(MetricFrame::around({at(-33.9, 151.2)}).name(), "EPSG:32756 (UTM zone 56 south)");
  // Two of three lie west of the border at 6 degrees; the third gets their zone.
  const MetricFrame border =
      MetricFrame::around({at(50.0, 5.9999), at(50.0, 5.9998), at(50.0, 6.0001)});
  EXPECT_EQ(border.name(), "EPSG:32631 (UTM zone 31 north)");
  const double step = border.to_map(at(50.0, 6.0001)).x - border.to_map(at(50.0, 5.9999)).x;
  EXPECT_NEAR(step, 14.3, 0.1) << "no jump at the border";
}

TEST(MetricFrame, ItsZoneIsReadFromItsReferenceSystem) {
  const auto zone = [](const std::string& crs, double x = 500000.0, double y = 5500000.0) {
    return utm_zone_at(crs, x, y);
  };
  EXPECT_EQ(zone(MetricFrame::around({at(46.84, -91.99)}).crs()), 15);
  EXPECT_EQ(zone(MetricFrame::around({at(-33.9, 151.2)}).crs()), -56);
  EXPECT_EQ(zone("EPSG:32632"), 32);
  EXPECT_EQ(zone("EPSG:32632+5773"), 32) << "with heights above a geoid";
  EXPECT_EQ(zone("EPSG:32632", 900000.0), std::nullopt) << "a place of zone 33";
  EXPECT_EQ(zone("EPSG:25832"), std::nullopt) << "ETRS89";
  EXPECT_EQ(zone("EPSG:3857"), std::nullopt);
  EXPECT_EQ(zone("EPSG:4326"), std::nullopt);
  EXPECT_EQ(zone(""), std::nullopt);
  EXPECT_EQ(zone("nowhere"), std::nullopt);
}

TEST(MetricFrame, TheAntimeridianIsNoGap) {
  const MetricFrame frame =
      MetricFrame::around({at(-17.0, 179.9999), at(-17.0, -179.9999), at(-17.0, 179.9998)});
  EXPECT_NEAR(frame.to_map(at(-17.0, -179.9999)).x - frame.to_map(at(-17.0, 179.9999)).x, 21.3,
              0.2);
}

TEST(MetricFrame, RefusesThePolesAndNothing) {
  expect_error(ErrorKind::kUsage, {"latitude 85.000", "UTM has no zone"},
               [] { MetricFrame::around({at(85.0, 10.0)}); });
  expect_error(ErrorKind::kUsage, {"no positions"}, [] { MetricFrame::around({}); });
}

/// On the central meridian x is 500 km and y is 0.9996 times the meridian arc, which is 4984944.378
/// m from the equator to 45 degrees on WGS84.
TEST(MetricFrame, AgreesWithTheMeridianArc) {
  const MetricFrame frame = MetricFrame::around({at(45.0, -93.0, 198.3)});
  const Point3<frames::Map> point = frame.to_map(at(45.0, -93.0, 198.3));
  EXPECT_NEAR(point.x, 500000.0, 1e-3);
  EXPECT_NEAR(point.y, 0.9996 * 4984944.378, 2e-3);
  EXPECT_DOUBLE_EQ(point.z, 198.3);
}

TEST(MetricFrame, RoundTrips) {
  const MetricFrame frame = MetricFrame::around({at(-33.9, 151.2)});
  for (const auto& place : {at(-33.9, 151.2, 5.0), at(-33.91, 151.21, -3.0)}) {
    const GeodeticPosition back = frame.to_geodetic(frame.to_map(place));
    EXPECT_NEAR(back.latitude_deg, place.latitude_deg, 1e-9);
    EXPECT_NEAR(back.longitude_deg, place.longitude_deg, 1e-9);
    EXPECT_EQ(back.altitude_m, place.altitude_m);
  }
}

/// At the eastern border of a zone, in the north, grid north points east of true north by
/// (lambda - lambda0) sin(phi), to first order.
TEST(MetricFrame, TrueHeadingsLoseTheGridConvergence) {
  const GeodeticPosition place = at(60.0, 5.999);
  const MetricFrame frame = MetricFrame::around({place});
  const double convergence = radians(5.999 - 3.0) * std::sin(radians(60.0));
  for (const double heading : {0.0, 90.0, 180.0, 270.0}) {
    const double expected = yaw_of_heading(radians(heading) - convergence);
    EXPECT_NEAR(wrap_angle(frame.yaw_of_true_heading(radians(heading), place) - expected), 0.0,
                radians(0.01))
        << heading;
  }
  // South of the equator it points to the other side.
  const GeodeticPosition south = at(-60.0, 5.999);
  EXPECT_NEAR(MetricFrame::around({south}).yaw_of_true_heading(0.0, south),
              radians(90.0) - convergence, radians(0.01));
}

/// A text out of a file must not make GDAL open files, ask the network or search a database.
TEST(GeodeticReader, TakesNoFileAddressOrName) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "utm.prj").string();
  test::write_text(file, test::wkt_of_epsg(32632));
  for (const std::string& text :
       {file, "/vsigzip/" + file, std::string("http://127.0.0.1:9/crs"), std::string("WGS 84"),
        std::string("+projection"), std::string("EPSG:32632/../x"), std::string("IGNF:LAMB93"),
        std::string("WGS84 UTM 99N"), std::string("WGS84 UTM 2147483647N"),
        std::string(70'000, 'A')}) {
    expect_error(ErrorKind::kInput, {"f:1", "is no reference system"},
                 [&] { GeodeticReader(text, "f:1"); });
  }
  EXPECT_NEAR(GeodeticReader("EPSG:25832+7837", "f:1").read(5e5, 5.3e6, 0, "f:2").longitude_deg,
              9.0, 1e-6);
}

TEST(GeodeticReader, KnowsTheNotationsOfOdm) {
  const double x = 576650.0, y = 5188221.0;
  const GeodeticPosition expected = GeodeticReader("EPSG:32615", "f:1").read(x, y, 7.0, "f:2");
  EXPECT_NEAR(expected.latitude_deg, 46.8426, 1e-3);
  EXPECT_NEAR(expected.longitude_deg, -91.9945, 1e-3);
  EXPECT_EQ(expected.altitude_m, 7.0);
  for (const char* text : {"WGS84 UTM 15N", "+proj=utm +zone=15 +datum=WGS84 +units=m +no_defs"}) {
    const GeodeticPosition position = GeodeticReader(text, "f:1").read(x, y, 7.0, "f:2");
    EXPECT_NEAR(position.latitude_deg, expected.latitude_deg, 1e-9) << text;
    EXPECT_NEAR(position.longitude_deg, expected.longitude_deg, 1e-9) << text;
  }
  EXPECT_NEAR(GeodeticReader("EPSG:4326", "f:1").read(8.5, 47.25, 0.0, "f:2").latitude_deg, 47.25,
              1e-12)
      << "longitude first";
  expect_error(ErrorKind::kInput, {"f:1", "'EPSG:nonsense' is no reference system"},
               [] { GeodeticReader("EPSG:nonsense", "f:1"); });
  expect_error(ErrorKind::kInput, {"f:2", "outside"},
               [] { GeodeticReader("EPSG:4326", "f:1").read(500000.0, 5e6, 0.0, "f:2"); });
}

TEST(Geocentric, RoundTripsAndEnuIsRightHanded) {
  const GeodeticPosition place = at(46.84, -91.99, 198.0);
  const GeodeticPosition back = from_geocentric(geocentric(place));
  EXPECT_NEAR(back.latitude_deg, place.latitude_deg, 1e-9);
  EXPECT_NEAR(back.longitude_deg, place.longitude_deg, 1e-9);
  EXPECT_NEAR(back.altitude_m, place.altitude_m, 1e-6);
  const Eigen::Matrix3d axes = geocentric_from_enu(place);
  EXPECT_NEAR(axes.determinant(), 1.0, 1e-12);
  const Eigen::Vector3d up = geocentric(at(46.84, -91.99, 199.0)) - geocentric(place);
  EXPECT_NEAR((up - axes.col(2)).norm(), 0.0, 1e-6);
  const Eigen::Vector3d north = geocentric(at(46.840001, -91.99, 198.0)) - geocentric(place);
  EXPECT_GT(north.normalized().dot(axes.col(1)), 0.999999);
}

}  // namespace
}  // namespace nadir
