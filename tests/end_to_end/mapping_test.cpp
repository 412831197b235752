// SPDX-License-Identifier: Apache-2.0
// `nadir map` on the real flight, as a user starts it.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "nadir/io/maps/elevation_file.hpp"
#include "nadir/io/maps/metric_frame.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/photos/photo_file.hpp"
#include "nadir/io/photos/photo_poses.hpp"
#include "support/data.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

TEST(Mapping, BrightonBeachIsMappedWhole) {
  const auto data = test::find_data("brighton_beach");
  if (!data) GTEST_SKIP() << test::kNoData;
  const fs::path folder = scratch_folder() / "brighton";
  fs::create_directories(folder);
  const fs::path map = folder / "map.tif";
  const Outcome outcome = nadir({"map", data->string(), "-o", map.string(), "--json", "-q"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["photos"], 18);
  EXPECT_EQ(document["registered"], 18);
  EXPECT_EQ(document["components"].size(), 1U);
  EXPECT_LT(document["reprojection_px"], 1.0);
  EXPECT_LE(document["gps_residual_m"], 0.7);
  EXPECT_GE(document["ground_below_camera_m"], 38.0);
  EXPECT_LE(document["ground_below_camera_m"], 42.0);
  EXPECT_EQ(document["gsd_m"], 0.1);
  EXPECT_GT(document["scale_sigma"], 0.0);
  EXPECT_TRUE(document["seconds"].contains("features"));
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  EXPECT_LT(used.ru_maxrss, 2'000'000) << "KiB";

  // All that was promised is there and fits together.
  const Orthomosaic ortho = read_orthomosaic(map);
  EXPECT_EQ(ortho.image.channels(), 3);
  EXPECT_NE(ortho.geo.crs.find("UTM zone 15N"), std::string::npos) << ortho.geo.crs;
  // The middle of the GPS positions, by another way, lies in the middle of the map.
  std::vector<GeodeticPosition> places;
  GeodeticPosition middle;
  const auto files = photo_files(*data);
  for (const auto& file : files) {
    places.push_back(read_photo_metadata(file).position.value());
    middle.latitude_deg += places.back().latitude_deg / static_cast<double>(files.size());
    middle.longitude_deg += places.back().longitude_deg / static_cast<double>(files.size());
  }
  const Point3<frames::Map> point = MetricFrame::around(places).to_map(middle);
  const PixelCoordinate pixel = ortho.geo.pixel_at(point.x, point.y);
  EXPECT_NEAR(pixel.column / ortho.width(), 0.5, 0.25);
  EXPECT_NEAR(pixel.row / ortho.height(), 0.5, 0.25);
  EXPECT_NO_THROW(read_elevation_map(folder / "map.surface.tif"));
  EXPECT_NO_THROW(read_elevation_map(folder / "map.quality.tif"));
  EXPECT_EQ(read_orthomosaic(folder / "map.views.tif").geo, ortho.geo);
  EXPECT_EQ(read_photo_poses(folder / "map.poses.json").poses.size(), 18U);
  const std::string page = read_file(folder / "map.report.html");
  for (const char* part : {"Footprints", "Seams", "data:image/png;base64,", "DJI_0018.JPG"}) {
    EXPECT_NE(page.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(page.find("http"), std::string::npos) << "the page needs nothing from elsewhere";

  // The poses that were written give the same map again, without solving.
  const Outcome again = nadir({"map", data->string(), "-o", (folder / "again.tif").string(),
                               "--poses", (folder / "map.poses.json").string(), "--json", "-q"});
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  const auto second = nlohmann::json::parse(again.output);
  EXPECT_EQ(second["registered"], 18);
  EXPECT_NEAR(second["ground_below_camera_m"], document["ground_below_camera_m"], 0.5);

  const Outcome refused = nadir({"map", data->string(), "-o", map.string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("--overwrite"), std::string::npos);
}

}  // namespace
}  // namespace nadir::testing
