// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/orthomosaic_import.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "io/gdal_files.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;
using test::TiffRecipe;

class OrthomosaicImport : public ::testing::Test {
 protected:
  ImportedOrthomosaic import(const TiffRecipe& recipe, const ImportOptions& options = {}) {
    test::write_tiff(file_, recipe);
    return import_orthomosaic(file_, options);
  }
  static bool notes_say(const ImportedOrthomosaic& imported, const std::string& part) {
    for (const std::string& note : imported.notes) {
      if (note.find(part) != std::string::npos) return true;
    }
    return false;
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "map.tif";
};

TEST_F(OrthomosaicImport, AGoodMapComesAsItIs) {
  TiffRecipe recipe;
  recipe.values = {77};
  recipe.epsg = 32650;
  const auto imported = import(recipe);
  EXPECT_TRUE(imported.notes.empty()) << imported.notes.front();
  EXPECT_EQ(imported.map.image, read_orthomosaic(file_).image);
  EXPECT_EQ(imported.map.geo, read_orthomosaic(file_).geo);
}

/// A grid turned by 30 degrees: a corner of the file must lie where its transform says.
TEST_F(OrthomosaicImport, ATurnedGridIsWarpedAndItsPlacesStay) {
  const double c = 0.5 * std::cos(0.5236), s = 0.5 * std::sin(0.5236);
  TiffRecipe recipe;
  recipe.width = 60;
  recipe.height = 40;
  recipe.values = {200};
  recipe.transform = {1000.0, c, s, 2000.0, s, -c};
  recipe.epsg = 32650;
  const auto imported = import(recipe);
  EXPECT_TRUE(notes_say(imported, "turned by 30.00 degrees"));
  const Orthomosaic& map = imported.map;
  EXPECT_NEAR(map.geo.resolution, 0.5, 0.03);
  const auto value_at = [&](double column, double row) {
    const PixelCoordinate p =
        map.geo.pixel_at(1000.0 + column * c + row * s, 2000.0 + column * s - row * c);
    const int x = static_cast<int>(p.column), y = static_cast<int>(p.row);
    return map.image.contains(x, y) && map.valid.at(x, y) != 0 ? map.image.at(x, y) : -1;
  };
  EXPECT_NEAR(value_at(30, 20), 200, 1);
  EXPECT_NEAR(value_at(57, 37), 200, 1);
  EXPECT_NEAR(value_at(57, 3), 200, 1);
  EXPECT_EQ(value_at(-3, 20), -1) << "a hole beside the image";
  EXPECT_EQ(value_at(30, 43), -1);
}

TEST_F(OrthomosaicImport, FlippedAndOblongGridsAreWarped) {
  TiffRecipe recipe;
  recipe.values = {100};
  recipe.transform = {0.0, 0.5, 0.0, 0.0, 0.0, 0.5};
  EXPECT_TRUE(notes_say(import(recipe), "flipped"));
  recipe.transform = {0.0, 0.5, 0.0, 0.0, 0.0, -0.25};
  EXPECT_TRUE(notes_say(import(recipe), "0.5 x 0.25"));
}

/// A degree of latitude is 111.2 km at 30 degrees north, wherever the file comes from.
TEST_F(OrthomosaicImport, GeographicAndMercatorGridsGoToUtm) {
  TiffRecipe recipe;
  recipe.width = 100;
  recipe.height = 100;
  recipe.values = {90};
  recipe.transform = {120.1, 1e-6, 0.0, 30.3, 0.0, -1e-6};
  recipe.epsg = 4326;
  const auto geographic = import(recipe);
  EXPECT_TRUE(notes_say(geographic, "EPSG:32651")) << "zone 51 begins at 120 degrees";
  EXPECT_TRUE(test::is_same_crs(geographic.map.geo.crs, test::wkt_of_epsg(32651)));
  const GeodeticPosition middle{30.29995, 120.10005, 0.0};
  const auto point = MetricFrame::around({middle}).to_map(middle);
  const PixelCoordinate pixel = geographic.map.geo.pixel_at(point.x, point.y);
  EXPECT_NEAR(pixel.column / geographic.map.width(), 0.5, 0.05);
  EXPECT_NEAR(pixel.row / geographic.map.height(), 0.5, 0.05);
  const double height_m = geographic.map.geo.resolution * geographic.map.height();
  EXPECT_NEAR(height_m, 100 * 1e-6 * 110850.0, 0.8);

  recipe.transform = {13369472.0, 0.1, 0.0, 3541866.0, 0.0, -0.1};
  recipe.epsg = 3857;
  const auto mercator = import(recipe);
  EXPECT_TRUE(notes_say(mercator, "Mercator"));
  // 100 px of 0.1 stretched metres are 10 m cos(latitude).
  const double latitude = 2.0 * std::atan(std::exp(3541866.0 / 6378137.0)) - M_PI / 2.0;
  EXPECT_NEAR(mercator.map.geo.resolution * mercator.map.width(), 10.0 * std::cos(latitude), 0.5);
}

TEST_F(OrthomosaicImport, BeyondUtmIsRefused) {
  TiffRecipe recipe;
  recipe.transform = {10.0, 1e-6, 0.0, 87.0, 0.0, -1e-6};
  recipe.epsg = 4326;
  test::write_tiff(file_, recipe);
  expect_error(ErrorKind::kInput, {"map.tif", "UTM has no zone", "gdalwarp"},
               [&] { import_orthomosaic(file_); });
}

TEST_F(OrthomosaicImport, AResultThatIsTooLargeIsRefused) {
  TiffRecipe recipe;  // a thin strip that lies askew
  recipe.width = 4;
  recipe.height = 3000;
  recipe.transform = {1000.0, 0.35, 0.35, 2000.0, 0.35, -0.35};
  test::write_tiff(file_, recipe);
  ImportOptions options;
  options.most_megapixels = 4.0;
  expect_error(ErrorKind::kInput, {"map.tif", "5 million pixels", "--gsd"},
               [&] { import_orthomosaic(file_, options); });
}

TEST_F(OrthomosaicImport, SixteenBitsAreStretchedByTheStatedRule) {
  TiffRecipe recipe;
  recipe.width = 1000;
  recipe.height = 1;
  recipe.type = GDT_UInt16;
  test::write_tiff(file_, recipe);
  {
    const auto dataset = GDALDataset::FromHandle(GDALOpen(file_.c_str(), GA_Update));
    std::vector<std::uint16_t> ramp(1000);
    for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<std::uint16_t>(60 * i);
    ASSERT_EQ(dataset->GetRasterBand(1)->RasterIO(GF_Write, 0, 0, 1000, 1, ramp.data(), 1000, 1,
                                                  GDT_UInt16, 0, 0, nullptr),
              CE_None);
    GDALClose(dataset);
  }
  const auto imported = import_orthomosaic(file_);
  EXPECT_TRUE(notes_say(imported, "1st to 99th percentile"));
  EXPECT_EQ(imported.map.image.at(0, 0), 0);
  EXPECT_EQ(imported.map.image.at(999, 0), 255);
  EXPECT_NEAR(imported.map.image.at(500, 0), 255.0 * (500 - 9) / (989 - 9), 1.0);
}

TEST_F(OrthomosaicImport, APaletteBecomesRgb) {
  TiffRecipe recipe;
  recipe.palette = true;
  const auto imported = import(recipe);
  ASSERT_EQ(imported.map.image.channels(), 3);
  EXPECT_EQ(imported.map.image.at(1, 1, 0), 255);
  EXPECT_EQ(imported.map.image.at(1, 1, 2), 0);
}

TEST_F(OrthomosaicImport, WhatCannotBeRightIsRefused) {
  TiffRecipe recipe;
  recipe.bands = 4;
  recipe.meaning = {GCI_CyanBand, GCI_MagentaBand, GCI_YellowBand, GCI_BlackBand};
  test::write_tiff(file_, recipe);
  expect_error(ErrorKind::kInput, {"CMYK"}, [&] { import_orthomosaic(file_); });
  recipe = {};
  recipe.values = {0};
  recipe.nodata = "0";
  test::write_tiff(file_, recipe);
  expect_error(ErrorKind::kInput, {"every pixel of it is a hole"},
               [&] { import_orthomosaic(file_); });
}

TEST_F(OrthomosaicImport, ACoarserGridIsAveragedByArea) {
  TiffRecipe recipe;
  recipe.width = 8;
  recipe.height = 8;
  recipe.transform = {1000.0, 0.05, 0.0, 2000.0, 0.0, -0.05};
  recipe.epsg = 32650;
  recipe.values = {100};  // the first pixel stays 0
  ImportOptions options;
  options.resolution_m = 0.1;
  const auto imported = import(recipe, options);
  EXPECT_EQ(imported.map.width(), 4);
  EXPECT_EQ(imported.map.geo.resolution, 0.1);
  EXPECT_NEAR(imported.map.image.at(0, 0), 75, 1);
  EXPECT_EQ(imported.map.image.at(2, 2), 100);
  EXPECT_TRUE(notes_say(imported, "averaged from 0.05 m to 0.1 m"));
  options.resolution_m = 0.02;
  EXPECT_TRUE(notes_say(import(recipe, options), "no more than before"));
}

TEST_F(OrthomosaicImport, APlainImageNeedsAScale) {
  cv::imwrite(folder_ / "plain.png", cv::Mat(30, 50, CV_8UC3, cv::Scalar(1, 2, 3)));
  const auto plain = folder_ / "plain.png";
  expect_error(ErrorKind::kInput, {"neither a geotransform nor a world file", "--metres-per-pixel"},
               [&] { import_orthomosaic(plain); });
  ImportOptions options;
  options.metres_per_pixel = 0.2;
  EXPECT_EQ(import_orthomosaic(plain, options).map.geo, (GeoReference{0.0, 6.0, 0.2, {}}));
  options.distance_m = 20.0;
  expect_error(ErrorKind::kUsage, {"belong together"}, [&] { import_orthomosaic(plain, options); });
  options.points_px = {0, 0, 30, 40};
  expect_error(ErrorKind::kUsage, {"given twice"}, [&] { import_orthomosaic(plain, options); });
  options.metres_per_pixel.reset();
  EXPECT_NEAR(import_orthomosaic(plain, options).map.geo.resolution, 0.4, 1e-12);
  options.resolution_m = 0.8;
  const Orthomosaic coarse = import_orthomosaic(plain, options).map;
  EXPECT_EQ(coarse.width(), 25);
  EXPECT_NEAR(coarse.geo.north, 12.0, 1e-12);
  options.crs = "EPSG:4326";
  expect_error(ErrorKind::kUsage, {"projected"}, [&] { import_orthomosaic(plain, options); });
  options.crs = "EPSG:32651";
  EXPECT_TRUE(
      test::is_same_crs(import_orthomosaic(plain, options).map.geo.crs, test::wkt_of_epsg(32651)));
}

TEST_F(OrthomosaicImport, OnlyTheCollarBecomesAHole) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar(90, 90, 90));
  image.rowRange(0, 4).setTo(cv::Scalar(255, 254, 253));
  image.at<cv::Vec3b>(10, 10) = {255, 255, 255};  // a white thing inside
  cv::imwrite(folder_ / "collar.png", image);
  ImportOptions options;
  options.metres_per_pixel = 0.1;
  EXPECT_EQ(import_orthomosaic(folder_ / "collar.png", options).map.valid.at(3, 3), 255);
  options.collar = Collar::kWhite;
  const auto imported = import_orthomosaic(folder_ / "collar.png", options);
  EXPECT_EQ(imported.map.valid.at(3, 3), 0);
  EXPECT_EQ(imported.map.valid.at(3, 4), 255);
  EXPECT_EQ(imported.map.valid.at(10, 10), 255);
  EXPECT_TRUE(notes_say(imported, "80 pixels of the white collar"));
}

}  // namespace
}  // namespace nadir
