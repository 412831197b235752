// SPDX-License-Identifier: Apache-2.0
// Which files are opened as maps and heights, and what their headers may declare: the same for
// every reader of rasters.

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "io/gdal_files.hpp"
#include "io/tiff_bytes.hpp"
#include "nadir/io/detail/utm.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/map_tiles.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/maps/orthomosaic_import.hpp"
#include "support/expect_error.hpp"
#include "support/nan.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

namespace fs = std::filesystem;
namespace tag = test::tiff_tags;
using test::expect_error;
using test::TiffTag;

class RasterFile : public ::testing::Test {
 protected:
  /// Every reader of rasters gives the same answer.
  void expect_refused(const fs::path& file, std::initializer_list<std::string> parts) const {
    expect_error(ErrorKind::kInput, parts, [&] { read_orthomosaic(file, PlainImageGeo{}); });
    expect_error(ErrorKind::kInput, parts, [&] { import_orthomosaic(file); });
    expect_error(ErrorKind::kInput, parts, [&] { MapTiles tiles(file); });
    expect_error(ErrorKind::kInput, parts, [&] { read_elevation_map(file); });
    EXPECT_FALSE(looks_like_heights(file));
  }
  void expect_bytes_refused(const std::string& bytes,
                            std::initializer_list<std::string> parts) const {
    test::write_text(file_, bytes);
    expect_refused(file_, parts);
  }
  /// A mosaic of 4 x 3 pixels with this text in its band.
  void expect_vrt_refused(const std::string& band, std::initializer_list<std::string> parts) const {
    test::write_text(
        vrt_, vrt_of("<VRTRasterBand dataType=\"Byte\" band=\"1\">" + band + "</VRTRasterBand>"));
    expect_refused(vrt_, parts);
  }
  static std::string vrt_of(const std::string& content) {
    return "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><GeoTransform>1000, 0.5, 0, 2000, 0, "
           "-0.5</GeoTransform>" +
           content + "</VRTDataset>";
  }
  static std::string source(const std::string& name, const std::string& kind = "SimpleSource") {
    return "<" + kind + "><SourceFilename relativeToVRT=\"1\">" + name +
           "</SourceFilename><SourceBand>1</SourceBand></" + kind + ">";
  }

  test::TemporaryFolder folder_;
  fs::path file_ = folder_ / "map.tif";
  fs::path vrt_ = folder_ / "map.vrt";
};

/// Some drivers of GDAL make room for what a header declares when they open a file.
TEST_F(RasterFile, OtherFormatsAreRefusedWithTheCure) {
  std::string table = "CTABLE V2" + std::string(151, '\0');
  table.replace(128, 8, std::string("\0\0\0\x10\x03\0\0\0", 8));  // 268 million columns, 3 rows
  expect_bytes_refused(table, {"map.tif", "GeoTIFF", "PNG", "JPEG", "VRT", "gdal_translate"});
  expect_bytes_refused("hello",
                       {"map.tif", "not a raster of a format that is read", "gdal_translate"});
  expect_bytes_refused(std::string("II\0\0\0\0\0\0", 8), {"map.tif", "not a raster of a format"});
  expect_bytes_refused("EHFA_HEADER_TAG" + std::string(100, '\0'), {"map.tif", "gdal_translate"});
}

TEST_F(RasterFile, FilesBehindGdalsVirtualSystemsAreRefused) {
  expect_refused(fs::path("/vsicurl/http://127.0.0.1:9/map.tif"), {"/vsicurl/", "gdal_translate"});
}

TEST_F(RasterFile, ATiffHasNoMoreBandsThanACameraGives) {
  for (const bool big : {false, true}) {
    expect_bytes_refused(test::tiff_bytes({{tag::kWidth, 3, 1, 4},
                                           {tag::kHeight, 3, 1, 15107},
                                           {tag::kBits, 3, 1, 8},
                                           {tag::kSamples, 3, 1, 65279}},
                                          big),
                         {"map.tif", "65279 bands", "1024", "gdal_translate -b 1 -b 2 -b 3"});
  }
}

TEST_F(RasterFile, ABlockOfATiffIsNoLargerThanTheFileCanHold) {
  for (const bool big : {false, true}) {
    expect_bytes_refused(test::tiff_bytes({{tag::kWidth, 3, 1, 20},
                                           {tag::kHeight, 3, 1, 16},
                                           {tag::kBits, 3, 1, 8},
                                           {tag::kCompression, 3, 1, 8},
                                           {tag::kPhotometric, 3, 1, 1},
                                           {tag::kSamples, 3, 1, 900},
                                           {tag::kPlanar, 3, 1, 1},
                                           {tag::kTileWidth, 3, 1, 512},
                                           {tag::kTileHeight, 3, 1, 512}},
                                          big),
                         {"map.tif", "512 x 512 pixels", "900 bands", "bytes cannot hold"});
  }
  expect_bytes_refused(test::tiff_bytes({{tag::kWidth, 4, 1, 30000},
                                         {tag::kHeight, 4, 1, 30000},
                                         {tag::kBits, 3, 1, 8},
                                         {tag::kCompression, 3, 1, 1},
                                         {tag::kSamples, 3, 1, 1},
                                         {tag::kRowsPerStrip, 4, 1, 30000}}),
                       {"map.tif", "30000 x 30000 pixels", "bytes cannot hold"});
}

/// What a later directory declares is looked at too: it may be an overview or a mask.
TEST_F(RasterFile, EveryDirectoryOfATiffIsLookedAt) {
  const auto file_of = [&](std::uint32_t samples) {
    std::string first = test::tiff_bytes({{tag::kWidth, 3, 1, 4}, {tag::kHeight, 3, 1, 4}});
    first.replace(first.size() - 4, 4, test::little_endian(first.size(), 4));
    std::string second = test::tiff_bytes({{tag::kSamples, 3, 1, samples}});
    return first + second.substr(8);
  };
  expect_bytes_refused(file_of(2304), {"2304 bands"});
}

/// Every directory takes 786 kB, and the next begins eight bytes behind it: 20,000 of them in 1 MB,
/// which to read would be 15 GB.
TEST_F(RasterFile, DirectoriesOfATiffDoNotOverlap) {
  constexpr std::uint32_t kCount = 20'000;
  constexpr std::uint32_t kEntries = 0xffff;
  constexpr std::uint32_t kPointer = 2 + 12 * kEntries;  // from the begin of a directory
  std::string bytes = "II*" + std::string(1, '\0') + test::little_endian(8, 4);
  bytes.resize(8 + 8 * kCount + kPointer + 4);
  for (std::uint32_t begin = 8; begin < 8 + 8 * kCount; begin += 8) {
    bytes.replace(begin, 2, test::little_endian(kEntries, 2));
    bytes.replace(begin + kPointer, 4, test::little_endian(begin + 8, 4));
  }
  expect_bytes_refused(bytes, {"map.tif", "directories overlap"});
}

TEST_F(RasterFile, LargeEmptyFilesAreRead) {
  for (const char* big : {"YES", "NO"}) {
    test::write_sparse_tiff(file_, 9000, 8000, {{"BIGTIFF", big}, {"TILED", "YES"}});
    EXPECT_EQ(MapTiles(file_).width(), 9000);
    EXPECT_EQ(read_orthomosaic(file_).image.at(8999, 7999), 0);
  }
  test::write_sparse_tiff(file_, 200'000, 200'000, {{"TILED", "YES"}, {"COMPRESS", "DEFLATE"}});
  EXPECT_EQ(MapTiles(file_).width(), 200'000);
}

TEST_F(RasterFile, AStripThatIsTheWholeImageIsRead) {
  test::write_sparse_tiff(file_, 12'000, 8'000, {{"BLOCKYSIZE", "8000"}, {"COMPRESS", "DEFLATE"}},
                          false);
  EXPECT_EQ(read_orthomosaic(file_).image.at(1, 1), 0);
}

/// GDAL would open what they name, anywhere, by any of its drivers.
TEST_F(RasterFile, AMapNamesNoOtherFileForItsOverviews) {
  test::TiffRecipe recipe;
  recipe.values = {77};
  recipe.metadata = {{"OVERVIEWS", "OVERVIEW_FILE", "/vsicurl/http://127.0.0.1:9/x.tif"}};
  test::write_tiff(file_, recipe);
  expect_error(ErrorKind::kInput, {"map.tif", "overviews", "gdal_translate"},
               [&] { read_orthomosaic(file_); });
}

TEST_F(RasterFile, FilesBesideAMapAreLookedAt) {
  test::TiffRecipe recipe;
  recipe.values = {77};
  test::write_tiff(file_, recipe);
  test::write_text(folder_ / "map.tif.ovr", "CTABLE V2");
  expect_error(ErrorKind::kInput, {"map.tif.ovr", "gdal_translate"},
               [&] { read_orthomosaic(file_); });
  fs::remove(folder_ / "map.tif.ovr");
  test::write_text(folder_ / "map.aux", "EHFA_HEADER_TAG" + std::string(100, '\0'));
  expect_error(ErrorKind::kInput, {"map.aux", "remove it"}, [&] { read_orthomosaic(file_); });
  fs::remove(folder_ / "map.aux");
  test::write_text(folder_ / "map.aux", "\\relax ");  // of LaTeX
  EXPECT_EQ(read_orthomosaic(file_).image.at(2, 2), 77);
}

TEST_F(RasterFile, AVirtualMosaicIsOfLocalFilesOfTheSameFormats) {
  test::TiffRecipe recipe;
  recipe.values = {77};
  test::write_tiff(file_, recipe);
  cv::imwrite(folder_ / "half.png", cv::Mat(3, 4, CV_8UC1, cv::Scalar(50)));
  test::write_text(vrt_, vrt_of("<VRTRasterBand dataType=\"Byte\" band=\"1\">" + source("map.tif") +
                                source("half.png", "ComplexSource") + "</VRTRasterBand>"));
  EXPECT_EQ(read_orthomosaic(vrt_).image.at(2, 2), 50);

  expect_vrt_refused(source("/vsicurl/http://127.0.0.1:9/a.tif"), {"map.vrt", "/vsicurl/"});
  expect_vrt_refused(source("NETCDF:map.tif:band"), {"map.vrt", "NETCDF:"});
  expect_vrt_refused(source("none.tif"), {"map.vrt", "none.tif"});
  expect_vrt_refused(source("map.vrt"), {"map.vrt", "another VRT"});
  test::write_text(folder_ / "table.tif", "CTABLE V2" + std::string(151, '\0'));
  expect_vrt_refused(source("table.tif"), {"table.tif", "gdal_translate"});
  expect_vrt_refused(source("map.tif", "KernelFilteredSource"),
                     {"map.vrt", "KernelFilteredSource", "gdal_translate"});
  test::write_text(vrt_, vrt_of("<VRTRasterBand dataType=\"Byte\" band=\"1\" "
                                "subClass=\"VRTRawRasterBand\">" +
                                source("map.tif") + "</VRTRasterBand>"));
  expect_refused(vrt_, {"map.vrt", "VRTRawRasterBand", "gdal_translate"});
  test::write_text(vrt_, "<VRTDataset subClass=\"VRTWarpedDataset\"/>");
  expect_refused(vrt_, {"map.vrt", "VRTWarpedDataset", "gdal_translate"});
  test::write_text(vrt_, "<VRTDataset rasterXSize=");
  expect_refused(vrt_, {"map.vrt"});
}

TEST_F(RasterFile, HeightsOfAnAsciiGridAreRead) {
  const fs::path grid = folder_ / "surface.asc";
  test::write_text(grid,
                   "ncols 3\nnrows 2\nxllcorner 1000\nyllcorner 2000\ncellsize 0.5\n"
                   "NODATA_value -9999\n1.5 2.5 -9999\n4 5 6\n");
  EXPECT_TRUE(looks_like_heights(grid));
  const ElevationMap surface = read_elevation_map(grid);
  EXPECT_EQ(surface.geo, (GeoReference{1000.0, 2001.0, 0.5, {}}));
  EXPECT_EQ(surface.height_m.at(1, 0), 2.5F);
  EXPECT_TRUE(std::isnan(surface.height_m.at(2, 0)));
  EXPECT_EQ(surface.height_m.at(2, 1), 6.0F);
  expect_bytes_refused("ncols 1\nnrows 2000000000\nxllcorner 0\nyllcorner 0\ncellsize 1\n1\n",
                       {"map.tif", "1 x 2000000000", "bytes cannot hold"});
}

/// Some reference systems hand a place that is none on as it is.
TEST_F(RasterFile, AGridOfNoPlaceIsNotFinite) {
  test::write_text(vrt_,
                   "<VRTDataset rasterXSize=\"4\" rasterYSize=\"3\"><SRS>EPSG:4326</SRS>"
                   "<GeoTransform>nan, 1, 0, nan, 0, -1</GeoTransform><VRTRasterBand "
                   "dataType=\"Float32\" band=\"1\"/></VRTDataset>");
  expect_error(ErrorKind::kInput, {"map.vrt", "not finite"}, [&] { read_elevation_map(vrt_); });
  const double nan = test::kNan;
  EXPECT_FALSE(utm_epsg(nan, nan));
  EXPECT_FALSE(utm_epsg(47.0, nan));
  EXPECT_FALSE(utm_epsg(nan, 9.0));
  EXPECT_FALSE(utm_epsg(47.0, 1e300));
  EXPECT_EQ(utm_epsg(47.0, 9.5), 32632);
  EXPECT_EQ(utm_epsg(-1.0, 180.0), 32760);
}

}  // namespace
}  // namespace nadir
