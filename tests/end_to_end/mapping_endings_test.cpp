// SPDX-License-Identifier: Apache-2.0
// `nadir map` through its endings, and photos and maps of odd names.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "end_to_end/endings.hpp"
#include "end_to_end/nadir_process.hpp"
#include "end_to_end/odd_names.hpp"
#include "end_to_end/small_flight.hpp"
#include "nadir/io/photos/photo_file.hpp"
#include "nadir/io/photos/photo_poses.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

Words map(const fs::path& photos, const fs::path& out, const Words& more = {}) {
  Words words{"map",   photos,
              "-o",    out,
              "-q",    "--overwrite",
              "--set", "aerial_mapping.features_per_photo=1500",
              "--set", "aerial_mapping.gps_sigma_m=0.5"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// Six photos that join.
const fs::path& photos() {
  static const fs::path folder = [] {
    fs::path made = scratch_folder() / "ending_photos";
    write_flight(made, {.strips = 2, .photos = 3});
    return made;
  }();
  return folder;
}

TEST(MapEndings, SoundRefusedAndNothing) {
  const fs::path out = scratch_folder() / "ending.tif";
  expect_ending(map(photos(), out), 0);
  expect_ending({"map", photos(), "-o", out}, 2);
  expect_ending(map("no/such", out), 3);
  // The place of a sister is taken by a folder.
  fs::create_directories(scratch_folder() / "taken.report.html");
  expect_ending(map(photos(), scratch_folder() / "taken.tif"), 1);
  const fs::path grey = scratch_folder() / "grey_photos";
  fs::create_directories(grey);
  for (const fs::path& file : photo_files(photos())) {
    Photo photo = read_photo(file, 0);
    std::ranges::fill(photo.image.values(), std::uint8_t{90});
    photo.image.at(0, 0) = static_cast<std::uint8_t>(file.filename().string()[3]);
    write_photo(grey / file.filename(), photo);
  }
  expect_ending(map(grey, scratch_folder() / "grey.tif"), 4);
}

TEST(MapEndings, PositionsOfOtherPhotosMakeTheMapDoubtful) {
  const fs::path out = scratch_folder() / "far.tif";
  ASSERT_EQ(nadir(map(photos(), out)).exit_code, 0);
  // In the other order.
  std::string list;
  const auto files = photo_files(photos());
  for (std::size_t i = 0; i < files.size(); ++i) {
    const GeodeticPosition place =
        read_photo_metadata(files[files.size() - 1 - i]).position.value();
    list += files[i].filename().string() + "," + std::to_string(place.latitude_deg) + "," +
            std::to_string(place.longitude_deg) + "," + std::to_string(place.altitude_m) + "\n";
  }
  write_file_as(scratch_folder() / "reversed.csv", list);
  const Outcome far =
      expect_ending(map(photos(), scratch_folder() / "far_again.tif",
                        {"--poses", (scratch_folder() / "far.poses.json").string(), "--positions",
                         (scratch_folder() / "reversed.csv").string()}),
                    5);
  EXPECT_NE(far.errors.find("the photos' positions differ by"), std::string::npos) << far.errors;
  const Json report = Json::parse(read_file(scratch_folder() / "far_again.report.json"));
  EXPECT_EQ(report["doubtful"], Json::parse(far.output)["doubtful"]);
}

TEST(MapEndings, AListOfOtherNamesMakesTheMapDoubtful) {
  const fs::path list = scratch_folder() / "other_names.csv";
  write_file_as(list, "q1.jpg,46,8,500\nq2.jpg,46.0001,8,500\n");
  const Outcome outcome =
      expect_ending(map(photos(), scratch_folder() / "other_names.tif", {"--positions", list}), 5);
  EXPECT_NE(outcome.errors.find("none of its names is that of a photo"), std::string::npos);
}

TEST(MapEndings, ASignalLeavesThePlaceAsItWas) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path out = scratch_folder() / "stopped" / "map.tif";
    NadirProcess process({"map", photos(), "-o", out, "--json", "--progress", "lines"});
    process.send_when(signal, " % ");
    const Outcome outcome = process.wait();
    EXPECT_EQ(outcome.exit_code, 128 + signal) << outcome.errors;
    const Json document = Json::parse(outcome.output, nullptr, false);
    EXPECT_EQ(document["error"]["exit_code"], 128 + signal) << outcome.output;
    EXPECT_FALSE(fs::exists(out));
  }
}

TEST(MapEndings, FollowingEndsWellByASignalBeforeThePhotosToo) {
  const fs::path place = scratch_folder() / "followed";
  fs::create_directories(place / "incoming");
  NadirProcess process({"map", place / "incoming", "-o", place / "map.tif", "--follow", "--json"});
  process.send_when(SIGTERM, "waiting for photos");
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(Json::parse(outcome.output, nullptr, false)["photos"], 0);
}

TEST(MapNames, PhotosAndMapsOfOddNames) {
  // All in one flight, so that it costs one map.
  const fs::path place = scratch_folder() / "odd\nphotos \xe9";
  fs::create_directories(place);
  const auto files = photo_files(photos());
  std::vector<std::string> names;
  for (std::size_t i = 0; i < kOddNames.size(); ++i) {
    names.push_back(kOddNames[i].with(static_cast<char>('a' + i), ".jpg"));
  }
  // Two that differ only in bytes that are not UTF-8: JSON text alone would make them one.
  names.insert(names.end(), {"caf\xe9.jpg", "caf\xe8.jpg", "-e.jpg"});
  ASSERT_EQ(names.size(), files.size());
  for (std::size_t i = 0; i < files.size(); ++i) fs::copy_file(files[i], place / names[i]);
  const fs::path out = place / "map \"\xe9\"\n.tif";
  expect_ending(map(place, out), 0);
  const fs::path poses = place / "map \"\xe9\"\n.poses.json";
  const ImportedPoses imported = read_photo_poses(poses);
  ASSERT_EQ(imported.poses.size(), names.size());
  std::ranges::sort(names);
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(imported.poses[i].name, names[i]);
  // And each pose goes to its own photo again.
  const Outcome again =
      expect_ending(map(place, place / "again.tif", {"--poses", poses.string()}), 0);
  const Json document = Json::parse(again.output);
  EXPECT_EQ(document["registered"], names.size());
  EXPECT_LT(document["gps_residual_m"], 1.0);
  expect_ending({"report", out}, 0);
  expect_ending({"info", out}, 0);
}

}  // namespace
}  // namespace nadir::testing
