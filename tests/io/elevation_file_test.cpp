// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/elevation_file.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>

#include "io/random_raster.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

/// Heights from below the sea to a mountain, a third of them unknown.
ElevationMap random_elevation(int width, int height, std::uint64_t seed) {
  const RandomStream random(seed, 4);
  ElevationMap elevation{{width, height}, {431000.5, 5182000.25, 0.25, {}}};
  for (std::size_t i = 0; i < elevation.height_m.values().size(); ++i) {
    const auto [value, unknown] = random.uniform_pair(i);
    elevation.height_m.values()[i] = unknown < 0.33 ? std::numeric_limits<float>::quiet_NaN()
                                                    : static_cast<float>(4500.0 * value - 430.0);
  }
  elevation.height_m.at(0, 0) = 0.0F;
  return elevation;
}

void expect_same(const ElevationMap& a, const ElevationMap& b) {
  EXPECT_EQ(a.geo, b.geo);
  ASSERT_TRUE(a.height_m.same_size(b.height_m));
  for (std::size_t i = 0; i < a.height_m.values().size(); ++i) {
    const float x = a.height_m.values()[i];
    const float y = b.height_m.values()[i];
    ASSERT_TRUE(x == y || (std::isnan(x) && std::isnan(y))) << i << ": " << x << " and " << y;
  }
}

TEST(ElevationFile, RoundTripsKnownAndUnknownHeights) {
  const TemporaryFolder folder;
  std::uint64_t seed = 0;
  for (const auto& [width, height] : {std::pair{1, 1}, {1, 7}, {31, 24}, {1500, 513}}) {
    const ElevationMap written = random_elevation(width, height, ++seed);
    write_elevation_map(folder / "surface.tif", written);
    expect_same(read_elevation_map(folder / "surface.tif"), written);
  }
}

TEST(ElevationFile, InfiniteHeightsAreUnknown) {
  const TemporaryFolder folder;
  ElevationMap written = random_elevation(3, 1, 1);
  written.height_m.values() = {1.0F, std::numeric_limits<float>::infinity(), -2.0F};
  write_elevation_map(folder / "surface.tif", written);
  EXPECT_TRUE(std::isnan(read_elevation_map(folder / "surface.tif").height_m.at(1, 0)));
}

TEST(ElevationFile, TheSameHeightsGiveTheSameBytes) {
  const TemporaryFolder folder;
  write_elevation_map(folder / "a.tif", random_elevation(40, 30, 5));
  write_elevation_map(folder / "b.tif", random_elevation(40, 30, 5));
  EXPECT_EQ(read_file(folder / "a.tif"), read_file(folder / "b.tif"));
}

TEST(ElevationFile, RefusesWhatHoldsNoHeights) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"nowhere.tif"},
               [&] { read_elevation_map(folder / "nowhere.tif"); });

  Orthomosaic colours = test::random_orthomosaic(4, 4, 3, 1);
  write_orthomosaic(folder / "colours.tif", colours);
  expect_error(ErrorKind::kInput, {"colours.tif", "3 bands", "gdal_translate -b 1"},
               [&] { read_elevation_map(folder / "colours.tif"); });

  ElevationMap empty = random_elevation(3, 3, 1);
  for (float& height : empty.height_m.values()) height = std::numeric_limits<float>::quiet_NaN();
  write_elevation_map(folder / "empty.tif", empty);
  expect_error(ErrorKind::kInput, {"empty.tif", "every value is nodata"},
               [&] { read_elevation_map(folder / "empty.tif"); });

  expect_error(ErrorKind::kUsage, {"surface.png", "write .tif"},
               [&] { write_elevation_map(folder / "surface.png", random_elevation(3, 3, 1)); });
}

TEST(ElevationFile, LeavesNothingHalfWritten) {
  const TemporaryFolder folder;
  const std::string bytes = [&] {
    write_elevation_map(folder / "whole.tif", random_elevation(300, 300, 2));
    return read_file(folder / "whole.tif");
  }();
  std::ofstream(folder / "cut.tif", std::ios::binary) << bytes.substr(0, bytes.size() / 2);
  expect_error(ErrorKind::kInput, {"cut.tif"}, [&] { read_elevation_map(folder / "cut.tif"); });
  expect_error(ErrorKind::kProcessing, {"no-folder"}, [&] {
    write_elevation_map(folder / "no-folder" / "surface.tif", random_elevation(3, 3, 1));
  });
}

TEST(ElevationFile, ASiteCarriesTheSurfaceAndTheHeightsOfItsFrames) {
  const TemporaryFolder folder;
  const ElevationMap surface = random_elevation(50, 40, 7);
  ElevationMap local = random_elevation(18, 12, 8);
  local.geo = {-0.9, 0.6, 0.1, {}};
  Orthomosaic image = test::random_orthomosaic(18, 12, 1, 2);
  image.geo = local.geo;
  SequenceWriter writer(folder / "site", "with heights");
  writer.write_surface(surface);
  writer.write_local_map(1, Stamp{1}, image, local);
  writer.write_local_map(2, Stamp{2}, image);
  writer.finish();

  const Sequence site = read_sequence(folder / "site");
  ASSERT_TRUE(site.surface);
  expect_same(read_elevation_map(*site.surface), surface);
  const Frame with = read_frame(site, site.local_maps[0]);
  ASSERT_TRUE(with.elevation);
  expect_same(*with.elevation, local);
  EXPECT_FALSE(read_frame(site, site.local_maps[1]).elevation);
}

}  // namespace
}  // namespace nadir
