// SPDX-License-Identifier: Apache-2.0
// What `nadir map` says of photos that are not as they should be: every line names what is wrong.
// Most cases end before a pixel is looked at (--dry-run), so that they cost little.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "nadir/io/photos/photo_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

/// A strip of small photos, 10 m apart, 40 m above the take-off.
Photo photo_of_strip(int number) {
  Photo photo;
  photo.image = Raster<std::uint8_t>(160, 120, static_cast<std::uint8_t>(80 + number), 3);
  PhotoMetadata& m = photo.metadata;
  m.make = "DJI";
  m.model = "FC6310";
  m.focal_length_mm = 8.8;
  m.position = GeodeticPosition{46.0 + 9e-5 * number, 8.0, 500.0};
  m.relative_altitude_m = 40.0;
  m.gimbal = GimbalAttitude{0.0, -90.0, 0.0};
  m.taken_at = Stamp{1'466'699'519'000'000'000 + 2'000'000'000LL * number};
  return photo;
}

class MappingBadInputTest : public ::testing::Test {
 protected:
  MappingBadInputTest() {
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "photos");
    for (int i = 0; i < 5; ++i) write(i, photo_of_strip(i));
  }

  fs::path file(int number) const {
    return folder_ / "photos" / (std::string(1, static_cast<char>('a' + number)) + ".jpg");
  }
  void write(int number, const Photo& photo) const { write_photo(file(number), photo); }
  template <class Change>
  void change(int number, Change&& how) const {
    Photo photo = photo_of_strip(number);
    how(photo);
    write(number, photo);
  }

  Outcome plan(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"map", (folder_ / "photos").string(), "-o",
                                       (folder_ / "map.tif").string(), "--dry-run"};
    // A pixel of these small photos is 0.375 m on the ground.
    if (std::ranges::find(more, "--gsd") == more.end()) {
      arguments.insert(arguments.end(), {"--gsd", "0.4"});
    }
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nadir(arguments);
  }
  void expect(const Outcome& outcome, int exit_code,
              std::initializer_list<const char*> parts) const {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    for (const char* part : parts) {
      EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << " in:\n" << outcome.errors;
    }
    EXPECT_FALSE(fs::exists(folder_ / "map.tif"));
  }
  fs::path write_list(const std::string& name, const std::string& text) const {
    write_file_as(folder_ / name, text);
    return folder_ / name;
  }

  fs::path folder_ = scratch_folder() / "mapping_bad_input";
};

TEST_F(MappingBadInputTest, AGoodFlightIsPlanned) {
  const Outcome outcome = plan({"--json"});
  ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["used"], 5);
  EXPECT_TRUE(document["warnings"].empty()) << document["warnings"].dump();
  EXPECT_NE(document["crs"].get<std::string>().find("EPSG:32632"), std::string::npos);
}

TEST_F(MappingBadInputTest, UnreadablePhotosAreNamedAndSkipped) {
  const std::string whole = read_file(file(1));
  write_file_as(file(1), whole.substr(0, whole.size() - 30));
  expect(plan(), 0, {"b.jpg", "cut off", "skipped"});
  write_file_as(file(2), "");
  write_file_as(file(3), "version https://git-lfs.github.com/spec/v1\n");
  expect(plan(), 3, {"3 of 5 photos cannot be read", "b.jpg, c.jpg, d.jpg"});
}

TEST_F(MappingBadInputTest, NoPhotosAtAll) {
  for (int i = 0; i < 5; ++i) fs::remove(file(i));
  expect(plan(), 3, {"holds no photos"});
}

TEST_F(MappingBadInputTest, NoPositionsNeedAScale) {
  for (int i = 0; i < 5; ++i) {
    change(i, [](Photo& photo) {
      photo.metadata.position.reset();
      photo.metadata.relative_altitude_m.reset();
    });
  }
  expect(plan(), 2, {"no positions: the map will have no scale", "--metres-per-pixel", "--gcp"});
  expect(plan({"--metres-per-pixel", "0.05"}), 0, {});
  const fs::path list = write_list("positions.csv",
                                   "a.jpg,46,8,500\nb.jpg,46.0001,8,500\nc.jpg,46.0002,8,500\n"
                                   "d.jpg,46.0003,8,500\ne.jpg,46.0004,8,500\nz.jpg,46,8,500\n");
  expect(plan({"--positions", list.string()}), 0, {"z.jpg", "not among the photos"});
}

TEST_F(MappingBadInputTest, DoubtfulPositionsAreNamed) {
  change(0, [](Photo& photo) { photo.metadata.position.reset(); });
  change(1, [](Photo& photo) { photo.metadata.position = GeodeticPosition{0.0, 0.0, 500.0}; });
  change(2, [](Photo& photo) { photo.metadata.position->altitude_m = 0.0; });
  change(4, [](Photo& photo) { photo.metadata.position = photo_of_strip(3).metadata.position; });
  expect(plan(), 0,
         {"a.jpg, b.jpg, e.jpg: no position", "c.jpg: no altitude",
          "e.jpg: the very position of another photo"});
}

TEST_F(MappingBadInputTest, AJumpIsNoPosition) {
  change(2, [](Photo& photo) { photo.metadata.position->longitude_deg += 0.2; });
  expect(plan(), 0, {"c.jpg: more than", "from every other photo"});
}

TEST_F(MappingBadInputTest, MixedSizesOfAnUnknownCamera) {
  for (int i = 0; i < 5; ++i) {
    change(i, [&](Photo& photo) {
      photo.metadata.model = "Kite";
      if (i == 3) photo.image = Raster<std::uint8_t>(160, 90, 90, 3);
    });
  }
  expect(plan(), 2, {"a.jpg is 160 x 120", "d.jpg is 160 x 90", "cropped"});
}

TEST_F(MappingBadInputTest, TagsThatMisleadAreTold) {
  change(0, [](Photo& photo) { photo.metadata.exif_width = 4000; });
  change(1, [](Photo& photo) { photo.metadata.orientation = 6; });
  change(2, [](Photo& photo) { photo.metadata.gimbal->pitch_deg = -20.0; });
  fs::copy_file(file(4), folder_ / "photos" / "f.jpg");
  expect(plan(), 0,
         {"EXIF says 4000 px", "b.jpg: an EXIF orientation tag", "c.jpg: look to the side",
          "f.jpg (as e.jpg): the same photo twice"});
}

TEST_F(MappingBadInputTest, FocalLengthsThatDisagree) {
  for (int i = 0; i < 5; ++i) {
    change(i, [](Photo& photo) { photo.metadata.focal_length_35mm = 35.0; });
  }
  expect(plan(), 0,
         {"focal length 107 px by sensor table", "156 px by its 35 mm equivalent",
          "the former is used"});
}

TEST_F(MappingBadInputTest, FinerThanThePhotos) {
  expect(plan({"--gsd", "0.1"}), 2, {"finer than half a pixel of the photos", "--gsd 0.375"});
  expect(plan({"--gsd", "0.3"}), 0, {"finer than the photos"});
}

TEST_F(MappingBadInputTest, LargerThanTheMachine) {
  for (int i = 0; i < 5; ++i) {
    change(i, [&](Photo& photo) { photo.metadata.position->latitude_deg = 46.0 + 0.003 * i; });
  }
  expect(plan({"--set", "aerial_mapping.max_megapixels=0.1"}), 2,
         {"million pixels", "coarser", "max_megapixels"});
  // Photos that are spread over a hundred kilometres each way.
  for (int i = 0; i < 5; ++i) {
    change(i, [&](Photo& photo) {
      photo.metadata.position->latitude_deg = 46.0 + 0.25 * i;
      photo.metadata.position->longitude_deg = 8.0 + 0.7 * (i % 3);
    });
  }
  expect(plan({"--gsd", "0.19", "--set", "aerial_mapping.max_megapixels=100000"}), 2,
         {"MB of memory", "this machine has", "--gsd"});
}

TEST_F(MappingBadInputTest, ControlPointsThatCannotBe) {
  const auto gcp = [&](const std::string& text) {
    return plan({"--gcp", write_list("gcp_list.txt", text).string()});
  };
  const std::string crs = "EPSG:4326\n";
  expect(gcp(crs + "8 46 460 10 10 a.jpg\n8.0001 46 460 10 10 a.jpg\n"), 2, {"2 control points"});
  expect(gcp(crs + "8 46 460 9 9 a.jpg\n8.0001 46 460 9 9 a.jpg\n8.0002 46 460 9 9 a.jpg\n"), 2,
         {"lie on a line"});
  expect(gcp(crs + "18 46 460 9 9 a.jpg\n18.0001 46 460 9 9 a.jpg\n18 46.0002 460 9 9 a.jpg\n"), 2,
         {"km from the photos", "reference system"});
  expect(gcp(crs + "8 46 460 9 500 a.jpg\n8.0001 46 460 9 9 a.jpg\n8 46.0002 460 9 9 a.jpg\n"), 2,
         {":2", "outside of a.jpg (160 x 120 px)"});
  expect(gcp("8 46 460 9 9 a.jpg\n"), 3, {"gcp_list.txt:1", "no reference system"});
}

TEST_F(MappingBadInputTest, MarksOfTheFullSizeAreScaled) {
  change(0, [](Photo& photo) { photo.metadata.exif_width = 4000; });
  const fs::path list = write_list("gcp_list.txt",
                                   "EPSG:4326\n8 46 460 3000 500 a.jpg\n"
                                   "8.0001 46 460 9 9 a.jpg\n8 46.0002 460 9 9 q.jpg\n");
  expect(plan({"--gcp", list.string()}), 0,
         {"pixels of the full size, 25 times", "q.jpg: marked in"});
}

TEST_F(MappingBadInputTest, NoUtmAtThePole) {
  for (int i = 0; i < 5; ++i) {
    change(i, [](Photo& photo) { photo.metadata.position->latitude_deg += 40.0; });
  }
  expect(plan(), 2, {"latitude 86.000", "UTM has no zone"});
}

TEST_F(MappingBadInputTest, OutputsThatCannotBe) {
  expect(nadir({"map", (folder_ / "photos").string(), "-o", (folder_ / "map.png").string()}), 2,
         {"GeoTIFF"});
  expect(nadir({"map", (folder_ / "photos").string(), "-o", (file(0) / "map.tif").string()}), 2,
         {"photos/a.jpg", "no folder for the map"});
  expect(
      nadir({"map", (folder_ / "photos").string(), "-o", (file(0) / "not/there/map.tif").string()}),
      2, {"photos/a.jpg", "no folder for the map"});
  expect(nadir({"map", (folder_ / "none").string(), "-o", (folder_ / "map.tif").string()}), 3,
         {"none"});
}

TEST_F(MappingBadInputTest, AMapInTheMakingTakesNoControlPoints) {
  expect(nadir({"map", (folder_ / "photos").string(), "-o", (folder_ / "map.tif").string(),
                "--follow", "--gcp", file(0).string()}),
         2, {"takes no --gcp", "without --follow"});
}

/// Photos without texture join nowhere: said, and nothing is written.
TEST_F(MappingBadInputTest, PhotosThatShowNothingDoNotJoin) {
  const Outcome outcome = nadir({"map", (folder_ / "photos").string(), "-o",
                                 (folder_ / "map.tif").string(), "--gsd", "0.4", "-q"});
  expect(outcome, 4, {"no two photos join"});
}

TEST_F(MappingBadInputTest, MapsOfOthersNeedAScaleAndSaySo) {
  const fs::path out = folder_ / "map.tif";
  expect(nadir({"convert", "map", file(0).string(), "-o", out.string()}), 3,
         {"neither a geotransform nor a world file", "--metres-per-pixel"});
  const Outcome done = nadir({"convert", "map", file(0).string(), "-o", out.string(),
                              "--metres-per-pixel", "0.2", "--gsd", "0.4"});
  EXPECT_EQ(done.exit_code, 0) << done.errors;
  EXPECT_NE(done.output.find("80 x 60 px"), std::string::npos) << done.output;
  EXPECT_NE(done.errors.find("local metres"), std::string::npos) << done.errors;
}

}  // namespace
}  // namespace nadir::testing
