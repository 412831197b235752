// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/track_file.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "io/gdal_files.hpp"
#include "nadir/core/angle.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

/// Two poses at the central meridian of zone 32, where grid north is true north.
Trajectory drive() {
  return {{Stamp{1'500'000'000}, {500000.0, 5000000.0, radians(90.0)}},
          {Stamp{2'500'000'000}, {500010.0, 5000000.0, 0.0}}};
}

TEST(TrackFile, GeoJsonIsWhereTheRobotWas) {
  const TemporaryFolder folder;
  write_track(folder / "trajectory.geojson", drive(), test::wkt_of_epsg(32632), "campus");
  const auto document = nlohmann::json::parse(test::read_text(folder / "trajectory.geojson"));
  const auto& features = document.at("features");
  ASSERT_EQ(features.size(), 3U);
  EXPECT_EQ(features[0]["geometry"]["type"], "LineString");
  EXPECT_EQ(features[0]["properties"]["name"], "campus");
  const auto& first = features[1];
  const double longitude = first["geometry"]["coordinates"][0];
  const double latitude = first["geometry"]["coordinates"][1];
  EXPECT_NEAR(longitude, 9.0, 1e-9);
  // There and back by another way.
  const GeodeticPosition place{latitude, longitude, 0.0};
  EXPECT_NEAR(MetricFrame::around({place}).to_map(place).y, 5000000.0, 1e-3);
  EXPECT_EQ(first["properties"]["stamp_s"], "1.500000000");
  EXPECT_NEAR(first["properties"]["heading_deg"].get<double>(), 0.0, 1e-6) << "north";
  EXPECT_NEAR(features[2]["properties"]["heading_deg"].get<double>(), 90.0, 1e-4) << "east";
  EXPECT_EQ(features[2]["properties"]["map_x"], 500010.0);
}

TEST(TrackFile, KmlHasLongitudeFirst) {
  const TemporaryFolder folder;
  write_track(folder / "trajectory.kml", drive(), test::wkt_of_epsg(32632), "campus");
  const std::string text = test::read_text(folder / "trajectory.kml");
  EXPECT_NE(text.find("<coordinates>9.0,45.15347718"), std::string::npos) << text;
  EXPECT_NE(text.find("campus"), std::string::npos);
}

TEST(TrackFile, NeedsAReferenceSystem) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kUsage, {"no reference system"},
               [&] { write_track(folder / "a.geojson", drive(), "", "x"); });
  expect_error(ErrorKind::kUsage, {"write .geojson or .kml"},
               [&] { write_track(folder / "a.shp", drive(), test::wkt_of_epsg(32632), "x"); });
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

}  // namespace
}  // namespace nadir
