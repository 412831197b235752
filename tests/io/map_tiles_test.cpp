// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/map_tiles.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "io/random_raster.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::TemporaryFolder;

cv::Mat decoded(const EncodedImage& image) {
  const std::vector<std::uint8_t> bytes(image.bytes.begin(), image.bytes.end());
  return cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
}

TEST(MapTiles, TheLastLevelHasThePixelsOfTheFile) {
  const TemporaryFolder folder;
  const Orthomosaic map = test::random_orthomosaic(1100, 700, 3, 1);  // a third of it holes
  write_orthomosaic(folder / "map.tif", map);
  MapTiles tiles(folder / "map.tif");
  EXPECT_EQ(tiles.width(), 1100);
  EXPECT_EQ(tiles.levels(), 3);  // 275 x 175, 550 x 350, 1100 x 700
  const auto tile = tiles.tile(2, 1, 1);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->media_type, "image/png");
  const cv::Mat pixels = decoded(*tile);
  ASSERT_EQ(pixels.size(), cv::Size(512, 512));
  for (int row = 0; row < 700 - 512; ++row) {
    for (int column = 0; column < 512; ++column) {
      const auto pixel = pixels.at<cv::Vec4b>(row, column);
      ASSERT_EQ(pixel[3], map.valid.at(512 + column, 512 + row));
      ASSERT_EQ(pixel[2], map.image.at(512 + column, 512 + row, 0));
      ASSERT_EQ(pixel[0], map.image.at(512 + column, 512 + row, 2));
    }
  }
  EXPECT_EQ(pixels.at<cv::Vec4b>(511, 0)[3], 0);  // below the map
}

TEST(MapTiles, CoarseLevelsAreMeansAndAWholeTileIsJpeg) {
  const TemporaryFolder folder;
  Orthomosaic map{{1024, 1024, 90, 1}, {1024, 1024, 255}, {0, 1024, 1, {}}};
  for (int row = 0; row < 1024; ++row) {
    for (int column = row % 2; column < 1024; column += 2) map.image.at(column, row) = 110;
  }
  write_orthomosaic(folder / "map.tif", map);
  MapTiles tiles(folder / "map.tif");
  const auto tile = tiles.tile(0, 0, 0);
  ASSERT_TRUE(tile);
  EXPECT_EQ(tile->media_type, "image/jpeg");
  EXPECT_NEAR(decoded(*tile).at<std::uint8_t>(200, 300), 100, 1);
}

TEST(MapTiles, ThereIsNothingOutside) {
  const TemporaryFolder folder;
  write_orthomosaic(folder / "map.tif", test::random_orthomosaic(600, 300, 1, 2));
  MapTiles tiles(folder / "map.tif");
  EXPECT_TRUE(tiles.tile(0, 0, 0));
  EXPECT_TRUE(tiles.tile(1, 1, 0));
  for (const auto& [level, column, row] : {std::tuple{-1, 0, 0},
                                           {2, 0, 0},
                                           {1, 2, 0},
                                           {1, 0, 1},
                                           {1, -1, 0},
                                           {1, 2147483647, 2147483647}}) {
    EXPECT_FALSE(tiles.tile(level, column, row)) << level << " " << column << " " << row;
  }
  test::expect_error(ErrorKind::kInput, {"none.tif"}, [&] { MapTiles none(folder / "none.tif"); });
}

}  // namespace
}  // namespace nadir
