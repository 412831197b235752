// SPDX-License-Identifier: Apache-2.0
// Parts of the program that live from files beside a map.

#include <gtest/gtest.h>

#include "nadir/core/error.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/pipelines/flight/growing_map_file.hpp"
#include "nadir/pipelines/flight/mapping_work.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::cli {
namespace {

Orthomosaic map_of_width(int width) {
  Orthomosaic map;
  map.image = Raster<std::uint8_t>(width, 8, 100, 3);
  map.valid = Raster<std::uint8_t>(width, 8, 255);
  map.geo = {0.0, 8.0, 0.1, {}};
  return map;
}

class GrowingMap : public testing::Test {
 protected:
  void write(int version, bool final) const {
    write_orthomosaic(map_, map_of_width(10 + version));
    test::write_text(update_file(map_), R"({"version": )" + std::to_string(version) +
                                            R"(, "final": )" + (final ? "true}" : "false}"));
  }
  test::TemporaryFolder folder_;
  std::filesystem::path map_ = folder_ / "live.tif";
};

TEST_F(GrowingMap, EachNewVersionIsGivenOnceUntilTheFinalOne) {
  write(3, false);
  ASSERT_TRUE(is_growing(map_));
  GrowingMapFile file(map_);
  EXPECT_FALSE(file.newer().has_value()) << "version 3 was there before";
  write(5, false);
  const auto fifth = file.newer();
  ASSERT_TRUE(fifth.has_value());
  EXPECT_EQ(fifth->width(), 15);
  EXPECT_EQ(file.version(), 5);
  EXPECT_FALSE(file.newer().has_value());
  write(6, true);
  EXPECT_TRUE(file.newer().has_value());
  write(7, false);
  EXPECT_FALSE(file.newer().has_value()) << "after the final version nothing comes";
}

TEST_F(GrowingMap, AFinishedMapDoesNotGrow) {
  write_orthomosaic(map_, map_of_width(10));
  EXPECT_FALSE(is_growing(map_));
  write(2, true);
  EXPECT_FALSE(is_growing(map_));
  test::write_text(update_file(map_), "{");
  EXPECT_THROW(is_growing(map_), Error);
}

TEST(MappingWork, GivesBackWhatItKeptUntilItIsRemoved) {
  const test::TemporaryFolder folder;
  MappingWork work(folder / "map.tif");
  EXPECT_FALSE(work.find("features a").has_value());
  work.keep("features a", std::string("bytes\0more", 10));
  MappingWork later(folder / "map.tif");
  EXPECT_EQ(later.find("features a"), std::string("bytes\0more", 10));
  EXPECT_FALSE(later.find("features b").has_value());
  EXPECT_EQ(later.taken_up(), 1);
  later.remove();
  EXPECT_FALSE(std::filesystem::exists(later.folder()));
  EXPECT_FALSE(later.find("features a").has_value());
}

}  // namespace
}  // namespace nadir::cli
