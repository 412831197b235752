// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/orthomosaic_file.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "io/gdal_files.hpp"
#include "io/random_raster.hpp"
#include "support/expect_error.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::random_orthomosaic;
using test::TemporaryFolder;

void expect_same(const Orthomosaic& a, const Orthomosaic& b) {
  EXPECT_EQ(a.image, b.image);
  EXPECT_EQ(a.valid, b.valid);
  EXPECT_DOUBLE_EQ(a.geo.resolution, b.geo.resolution);
  EXPECT_NEAR(a.geo.west, b.geo.west, 1e-8);
  EXPECT_NEAR(a.geo.north, b.geo.north, 1e-8);
  EXPECT_EQ(a.geo.crs, b.geo.crs);
}

class RoundTrip : public ::testing::TestWithParam<const char*> {};

TEST_P(RoundTrip, KeepsPixelsHolesAndPlace) {
  const TemporaryFolder folder;
  std::uint64_t seed = 0;
  for (const int channels : {1, 3}) {
    for (const auto& [width, height] : {std::pair{1, 1}, {1, 6}, {9, 1}, {31, 24}, {600, 513}}) {
      const Orthomosaic written = random_orthomosaic(width, height, channels, ++seed);
      write_orthomosaic(folder / GetParam(), written);
      expect_same(read_orthomosaic(folder / GetParam()), written);
    }
  }
}

TEST_P(RoundTrip, KeepsAnImageWithoutHoles) {
  const TemporaryFolder folder;
  Orthomosaic written = random_orthomosaic(20, 10, 3, 1);
  written.valid = {20, 10, 255};
  write_orthomosaic(folder / GetParam(), written);
  expect_same(read_orthomosaic(folder / GetParam()), written);
}

TEST_P(RoundTrip, AnyMaskValueButZeroIsSeen) {
  const TemporaryFolder folder;
  Orthomosaic written = random_orthomosaic(2, 1, 1, 1);
  written.valid.values() = {0, 1};
  write_orthomosaic(folder / GetParam(), written);
  EXPECT_EQ(read_orthomosaic(folder / GetParam()).valid.values(),
            (std::vector<std::uint8_t>{0, 255}));
}

TEST_P(RoundTrip, KeepsTheReferenceSystem) {
  const TemporaryFolder folder;
  Orthomosaic written = random_orthomosaic(4, 4, 1, 1);
  written.geo.crs = test::wkt_of_epsg(32650);
  write_orthomosaic(folder / GetParam(), written);
  const Orthomosaic once = read_orthomosaic(folder / GetParam());
  EXPECT_TRUE(test::is_same_crs(once.geo.crs, written.geo.crs)) << once.geo.crs;
  write_orthomosaic(folder / GetParam(), once);
  EXPECT_EQ(read_orthomosaic(folder / GetParam()).geo.crs, once.geo.crs);

  written.geo.crs.clear();  // and it does not linger
  write_orthomosaic(folder / GetParam(), written);
  EXPECT_EQ(read_orthomosaic(folder / GetParam()).geo.crs, "");
}

TEST_P(RoundTrip, WritesTheSameBytesAgain) {
  const TemporaryFolder folder;
  const Orthomosaic written = random_orthomosaic(70, 40, 3, 5);
  write_orthomosaic(folder / GetParam(), written);
  const std::string bytes = test::read_text(folder / GetParam());
  write_orthomosaic(folder / GetParam(), written);
  EXPECT_EQ(test::read_text(folder / GetParam()), bytes);
}

TEST_P(RoundTrip, LeavesNothingBehindWhenItFails) {
  const TemporaryFolder folder;
  const Orthomosaic old = random_orthomosaic(8, 8, 1, 3);
  write_orthomosaic(folder / GetParam(), old);
  const int entries = test::count_entries(folder.path());

  const Orthomosaic larger = random_orthomosaic(300, 300, 3, 4);
  {
    const test::FullDisk full;
    expect_error(ErrorKind::kProcessing, {GetParam(), "cannot be written", "free space"},
                 [&] { write_orthomosaic(folder / GetParam(), larger); });
  }
  EXPECT_EQ(test::count_entries(folder.path()), entries);
  expect_same(read_orthomosaic(folder / GetParam()), old);
}

TEST_P(RoundTrip, RefusesAFolderThatIsNotThere) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kProcessing, {"cannot be written"}, [&] {
    write_orthomosaic(folder.path() / "none" / GetParam(), random_orthomosaic(3, 3, 1, 1));
  });
}

INSTANTIATE_TEST_SUITE_P(OrthomosaicFile, RoundTrip, ::testing::Values("map.tif", "map.png"),
                         [](const auto& tested) { return std::string(tested.param).substr(4); });

TEST(OrthomosaicFile, AWorldFileNamesTheCentreOfTheFirstPixel) {
  const TemporaryFolder folder;
  Orthomosaic written = random_orthomosaic(4, 4, 1, 1);
  written.geo = {-8.0, 8.0, 0.5, {}};
  write_orthomosaic(folder / "map.png", written);
  EXPECT_EQ(test::read_text(folder / "map.pgw"), "0.5\n0\n0\n-0.5\n-7.75\n7.75\n");
}

TEST(OrthomosaicFile, AGeoTiffNamesTheCornerAndHasOverviewsWhenLarge) {
  const TemporaryFolder folder;
  Orthomosaic written = random_orthomosaic(1100, 40, 1, 1);
  written.geo = {-8.0, 8.0, 0.5, {}};
  write_orthomosaic(folder / "map.tif", written);
  const test::TiffFacts facts = test::tiff_facts(folder / "map.tif");
  EXPECT_EQ(facts.west, -8.0);
  EXPECT_EQ(facts.north, 8.0);
  EXPECT_EQ(facts.block_size, 512);
  EXPECT_EQ(facts.compression, "DEFLATE");
  EXPECT_EQ(facts.overviews, 2);
  EXPECT_EQ(test::count_entries(folder.path()), 1) << "the mask is inside";
}

TEST(OrthomosaicFile, APlainImageHasItsOriginAtTheLowerLeftCorner) {
  const TemporaryFolder folder;
  cv::imwrite(folder / "plain.jpg", cv::Mat(30, 20, CV_8UC3, cv::Scalar::all(7)));
  const Orthomosaic map = read_orthomosaic(folder / "plain.jpg", PlainImageGeo{0.5});
  EXPECT_EQ(map.geo, (GeoReference{0.0, 15.0, 0.5, {}}));
  EXPECT_EQ(map.image.channels(), 3);
  EXPECT_EQ(map.valid, (Raster<std::uint8_t>(20, 30, 255)));
  expect_error(ErrorKind::kInput, {"plain.jpg", "no geo-reference", "metres per pixel"},
               [&] { read_orthomosaic(folder / "plain.jpg"); });
  expect_error(ErrorKind::kUsage, {"above 0"},
               [&] { read_orthomosaic(folder / "plain.jpg", PlainImageGeo{0.0}); });
}

TEST(OrthomosaicFile, RefusesWhatIsNoOrthomosaic) {
  const TemporaryFolder folder;
  Orthomosaic bad = random_orthomosaic(5, 5, 1, 1);
  bad.valid = {4, 5};
  expect_error(ErrorKind::kProcessing, {"no orthomosaic"},
               [&] { write_orthomosaic(folder / "map.tif", bad); });
  expect_error(ErrorKind::kUsage, {".bmp", "write .tif or .png"},
               [&] { write_orthomosaic(folder / "map.bmp", random_orthomosaic(5, 5, 1, 1)); });
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

}  // namespace
}  // namespace nadir
