// SPDX-License-Identifier: Apache-2.0
// Orthomosaics that other programs made.

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "io/gdal_files.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;
using test::TiffRecipe;

class ForeignOrthomosaic : public ::testing::Test {
 protected:
  Orthomosaic read(const TiffRecipe& recipe) {
    test::write_tiff(file_, recipe);
    return read_orthomosaic(file_);
  }
  void refuse(const TiffRecipe& recipe, std::initializer_list<std::string> parts) {
    test::write_tiff(file_, recipe);
    expect_error(ErrorKind::kInput, parts, [this] { read_orthomosaic(file_); });
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "map.tif";
};

TEST_F(ForeignOrthomosaic, TakesHolesFromAlpha) {
  TiffRecipe recipe;
  recipe.bands = 4;
  recipe.values = {10, 20, 30, 128};  // half transparent is seen
  recipe.meaning = {GCI_RedBand, GCI_GreenBand, GCI_BlueBand, GCI_AlphaBand};
  const Orthomosaic map = read(recipe);
  EXPECT_EQ(map.image.channels(), 3);
  EXPECT_EQ(map.image.at(2, 1, 1), 20);
  EXPECT_EQ(map.valid.at(0, 0), 0);
  EXPECT_EQ(map.valid.at(1, 0), 255);
  EXPECT_EQ(map.geo, (GeoReference{1000.0, 2000.0, 0.5, {}}));
}

TEST_F(ForeignOrthomosaic, TakesHolesFromNodataWhereEveryColourIsNodata) {
  TiffRecipe recipe;
  recipe.bands = 3;
  recipe.values = {0, 20, 30};
  recipe.nodata = "0";
  const Orthomosaic map = read(recipe);
  EXPECT_EQ(map.valid.at(0, 0), 0);
  EXPECT_EQ(map.valid.at(1, 0), 255);
}

TEST_F(ForeignOrthomosaic, OrdersColoursByTheirMeaning) {
  TiffRecipe recipe;
  recipe.bands = 3;
  recipe.values = {30, 20, 10};
  recipe.meaning = {GCI_BlueBand, GCI_GreenBand, GCI_RedBand};
  EXPECT_EQ(read(recipe).image.at(1, 1, 0), 10);
}

TEST_F(ForeignOrthomosaic, RefusesOtherPixels) {
  TiffRecipe recipe;
  recipe.type = GDT_UInt16;
  refuse(recipe, {"map.tif", "UInt16", "gdal_translate -ot Byte -scale"});
  recipe = {};
  recipe.type = GDT_Float32;
  refuse(recipe, {"map.tif", "heights", "give the orthomosaic"});
  recipe = {};
  recipe.palette = true;
  refuse(recipe, {"palette", "gdal_translate -expand rgb"});
  recipe = {};
  recipe.bands = 4;
  recipe.meaning = {GCI_CyanBand, GCI_MagentaBand, GCI_YellowBand, GCI_BlackBand};
  refuse(recipe, {"CMYK"});
  recipe = {};
  recipe.bands = 5;
  refuse(recipe, {"5 colour bands", "gdal_translate -b 1 -b 2 -b 3"});
}

TEST_F(ForeignOrthomosaic, RefusesOtherGridsAndNamesTheCure) {
  TiffRecipe recipe;
  recipe.transform = {0.0, 0.4, 0.3, 0.0, 0.3, -0.4};
  refuse(recipe, {"map.tif", "rotated", "gdalwarp"});
  recipe.transform = {0.0, 0.5, 0.0, 0.0, 0.0, 0.5};
  refuse(recipe, {"rotated or flipped", "gdalwarp"});
  recipe.transform = {0.0, 0.5, 0.0, 0.0, 0.0, -0.25};
  refuse(recipe, {"not square (0.5 x 0.25 m)", "gdalwarp -tr 0.5 0.5"});
  recipe.transform = {120.1, 1e-6, 0.0, 30.3, 0.0, -1e-6};
  recipe.epsg = 4326;
  refuse(recipe, {"geographic", "gdalwarp -t_srs EPSG:32651"});
  recipe.transform = {13369472.0, 0.1, 0.0, -3541866.0, 0.0, -0.1};
  recipe.epsg = 3857;
  refuse(recipe, {"Mercator", "gdalwarp -t_srs EPSG:32751"});
  recipe.transform = {1000.0, 0.5, 0.0, 2000.0, 0.0, -0.5};
  recipe.epsg = 2263;  // New York, feet
  refuse(recipe, {"not the metre", "gdalwarp -t_srs EPSG:326"});
}

TEST_F(ForeignOrthomosaic, ToleratesRoundingOfSquarePixels) {
  TiffRecipe recipe;
  recipe.transform[5] = -0.5 * (1.0 + 1e-7);
  EXPECT_EQ(read(recipe).geo.resolution, 0.5);
}

TEST_F(ForeignOrthomosaic, ReadsAnImageWithWorldFileAndReferenceSystem) {
  cv::imwrite(folder_ / "map.jpg", cv::Mat(3, 4, CV_8UC1, cv::Scalar(50)));
  test::write_text(folder_ / "map.jgw", "0.5\n0\n0\n-0.5\n1000.25\n1999.75\n");
  test::write_text(folder_ / "map.prj", test::wkt_of_epsg(32650));
  const Orthomosaic map = read_orthomosaic(folder_ / "map.jpg", PlainImageGeo{9.0});
  EXPECT_EQ(map.geo.west, 1000.0);
  EXPECT_EQ(map.geo.north, 2000.0);
  EXPECT_TRUE(test::is_same_crs(map.geo.crs, test::wkt_of_epsg(32650)));

  test::write_text(folder_ / "map.prj", "nonsense");
  expect_error(ErrorKind::kInput, {"map.prj", "not a coordinate reference system"},
               [&] { read_orthomosaic(folder_ / "map.jpg"); });
}

TEST_F(ForeignOrthomosaic, ReadsAVirtualMosaic) {
  TiffRecipe recipe;
  recipe.values = {77};
  test::write_tiff(file_, recipe);
  test::write_text(folder_ / "map.vrt", R"(<VRTDataset rasterXSize="4" rasterYSize="3">
    <GeoTransform>1000, 0.5, 0, 2000, 0, -0.5</GeoTransform>
    <VRTRasterBand dataType="Byte" band="1"><SimpleSource>
      <SourceFilename relativeToVRT="1">map.tif</SourceFilename><SourceBand>1</SourceBand>
    </SimpleSource></VRTRasterBand></VRTDataset>)");
  EXPECT_EQ(read_orthomosaic(folder_ / "map.vrt").image.at(2, 2), 77);
}

TEST_F(ForeignOrthomosaic, RefusesDamagedFiles) {
  expect_error(ErrorKind::kInput, {"none.tif", "no such file"},
               [&] { read_orthomosaic(folder_ / "none.tif"); });
  test::write_text(folder_ / "text.tif", "hello");
  expect_error(ErrorKind::kInput, {"text.tif", "not a raster of a format that is read"},
               [&] { read_orthomosaic(folder_ / "text.tif"); });
  test::write_text(folder_ / "pointer.tif", "version https://git-lfs.github.com/spec/v1\n");
  expect_error(ErrorKind::kInput, {"Git LFS pointer"},
               [&] { read_orthomosaic(folder_ / "pointer.tif"); });

  cv::Mat noise(200, 200, CV_8UC1);
  cv::randu(noise, 0, 256);
  cv::imwrite(folder_ / "whole.jpg", noise);
  const std::string jpeg = test::read_text(folder_ / "whole.jpg");
  test::write_text(folder_ / "cut.jpg", jpeg.substr(0, jpeg.size() / 2));
  expect_error(ErrorKind::kInput, {"cut.jpg", "cut off"},
               [&] { read_orthomosaic(folder_ / "cut.jpg", PlainImageGeo{}); });
}

TEST_F(ForeignOrthomosaic, RefusesATruncatedGeoTiff) {
  Orthomosaic whole{Raster<std::uint8_t>(900, 900), Raster<std::uint8_t>(900, 900, 255), {}};
  for (std::size_t i = 0; i < whole.image.values().size(); ++i) {
    whole.image.values()[i] = static_cast<std::uint8_t>(i * i / 7);
  }
  write_orthomosaic(file_, whole);
  std::filesystem::resize_file(file_, std::filesystem::file_size(file_) / 2);
  expect_error(ErrorKind::kInput, {"map.tif"}, [this] { read_orthomosaic(file_); });
}

}  // namespace
}  // namespace nadir
