// SPDX-License-Identifier: Apache-2.0
// Lists that people write beside their photos: positions and ground control points.

#include <gtest/gtest.h>

#include "nadir/io/photos/control_points.hpp"
#include "nadir/io/photos/position_list.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

std::vector<ListedPosition> positions_of(const std::string& text) {
  const TemporaryFolder folder;
  test::write_text(folder / "positions.csv", text);
  return read_positions(folder / "positions.csv");
}

std::vector<ListedControlPoint> points_of(const std::string& text) {
  const TemporaryFolder folder;
  test::write_text(folder / "gcp_list.txt", text);
  return read_control_points(folder / "gcp_list.txt");
}

TEST(PositionList, ReadsCsvWithAndWithoutHeader) {
  const std::string plain = "a.jpg,46.5,-91.25,198.5,45,-89,1,0.02\nb.jpg, 46.6, -91.26 ,,,,,\r\n";
  for (const std::string& text : {plain, "name,lat,lon,alt,yaw,pitch,roll,sigma\n" + plain}) {
    const auto list = positions_of(text);
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].photo, "a.jpg");
    EXPECT_EQ(list[0].position.latitude_deg, 46.5);
    EXPECT_EQ(list[0].position.longitude_deg, -91.25);
    EXPECT_EQ(list[0].position.altitude_m, 198.5);
    EXPECT_EQ(list[0].position.horizontal_sigma_m, 0.02);
    EXPECT_EQ(list[0].attitude.value().yaw_deg, 45.0);
    EXPECT_EQ(list[0].attitude.value().pitch_deg, -89.0);
    EXPECT_FALSE(list[1].attitude);
    EXPECT_FALSE(list[1].position.altitude_known);
  }
}

TEST(PositionList, AHeaderMayGiveAnotherOrder) {
  const auto list = positions_of("Longitude;Latitude;Image\n-91.25;46.5;a.jpg\n");
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].photo, "a.jpg");
  EXPECT_EQ(list[0].position.latitude_deg, 46.5);
}

TEST(PositionList, ReadsGeoTxt) {
  const auto geographic = positions_of("EPSG:4326\na.jpg -91.25 46.5 198.5 0 0 0 0.05 0.1\n");
  ASSERT_EQ(geographic.size(), 1U);
  EXPECT_NEAR(geographic[0].position.latitude_deg, 46.5, 1e-12);
  EXPECT_EQ(geographic[0].position.altitude_m, 198.5);
  EXPECT_EQ(geographic[0].position.horizontal_sigma_m, 0.05);
  EXPECT_EQ(geographic[0].position.vertical_sigma_m, 0.1);
  const auto utm = positions_of("WGS84 UTM 15N\na.jpg 576650 5188221\n");
  EXPECT_NEAR(utm[0].position.latitude_deg, 46.8426, 1e-3);
  EXPECT_FALSE(utm[0].position.altitude_known);
}

TEST(PositionList, NamesTheLineThatIsWrong) {
  expect_error(ErrorKind::kInput, {"positions.csv:2", "lat"},
               [] { positions_of("a.jpg,46,8,1\nb.jpg,north,8,1\n"); });
  expect_error(ErrorKind::kInput, {":1", "impossible", "latitude first"},
               [] { positions_of("a.jpg,-191.2,46,1\n"); });
  expect_error(ErrorKind::kInput, {":2", "a.jpg is listed twice"},
               [] { positions_of("a.jpg,46,8,1\na.jpg,46,8,1\n"); });
  expect_error(ErrorKind::kInput, {":1", "2 fields"}, [] { positions_of("a.jpg,46\n"); });
  expect_error(ErrorKind::kInput, {":1", "no column 'lon'"},
               [] { positions_of("name,lat,height\na.jpg,46,1\n"); });
  expect_error(ErrorKind::kInput, {"is empty"}, [] { positions_of(""); });
}

TEST(ControlPoints, MarksOfOnePlaceAreOnePoint) {
  const auto points = points_of(
      "EPSG:32615\n"
      "576650 5188221 190.5 100.5 200 a.jpg corner\n"
      "576650 5188221 190.5 300 400 b.jpg corner\n"
      "# a comment\n"
      "576660 5188231 191.5 10 20 a.jpg\n");
  ASSERT_EQ(points.size(), 2U);
  EXPECT_EQ(points[0].name, "corner");
  ASSERT_EQ(points[0].marks.size(), 2U);
  EXPECT_EQ(points[0].marks[1].photo, "b.jpg");
  EXPECT_EQ(points[0].marks[0].u, 100.5);
  EXPECT_EQ(points[0].position.altitude_m, 190.5);
  EXPECT_EQ(points[1].name, "gcp2");
}

TEST(ControlPoints, NamesTheLineThatIsWrong) {
  expect_error(ErrorKind::kInput, {"gcp_list.txt:1", "no reference system"},
               [] { points_of("576650 5188221 190 1 2 a.jpg\n"); });
  expect_error(ErrorKind::kInput, {":2", "5 fields", "east north height column row photo"},
               [] { points_of("EPSG:32615\n576650 5188221 190 1 2\n"); });
  expect_error(ErrorKind::kInput, {":2", "outside"},
               [] { points_of("EPSG:4326\n576650 5188221 190 1 2 a.jpg\n"); });
  expect_error(ErrorKind::kInput, {":3", "stands for two places"}, [] {
    points_of("EPSG:32615\n576650 5188221 190 1 2 a.jpg p\n576651 5188221 190 1 2 a.jpg p\n");
  });
  expect_error(ErrorKind::kInput, {"no control points"}, [] { points_of("EPSG:32615\n"); });
}

}  // namespace
}  // namespace nadir
