// SPDX-License-Identifier: Apache-2.0
// `nadir map --follow`, while photos fall into its folder; and flights that do not hold together.

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <thread>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_flight.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using namespace std::chrono_literals;

const std::vector<std::string> kQuick{"--set", "aerial_mapping.features_per_photo=1500", "--set",
                                      "aerial_mapping.gps_sigma_m=0.5"};

std::vector<std::string> with_quick(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), kQuick.begin(), kQuick.end());
  return arguments;
}

/// Puts a photo into the folder at once, as a download that is renamed when it is done.
void drop(const fs::path& photo, const fs::path& folder) {
  const fs::path partial = folder / (photo.filename().string() + ".part");
  fs::copy_file(photo, partial);
  fs::rename(partial, folder / photo.filename());
}

/// Waits for the update of a version; empty where it does not come.
Json wait_for(const fs::path& update, int version) {
  for (int tries = 0; tries < 600; ++tries) {
    const Json document = Json::parse(read_file(update), nullptr, false);
    if (document.is_object() && document["version"] >= version) return document;
    std::this_thread::sleep_for(100ms);
  }
  return {};
}

/// Waits until the program has said something.
bool says(const NadirProcess& process, const std::string& text) {
  for (int tries = 0; tries < 600; ++tries) {
    if (process.errors_so_far().find(text) != std::string::npos) return true;
    std::this_thread::sleep_for(100ms);
  }
  return false;
}

/// Share of the pixels, valid in both maps, whose colours are the same.
double same_share(const Orthomosaic& a, const Orthomosaic& b) {
  const auto right = static_cast<int>(std::lround((a.geo.west - b.geo.west) / a.geo.resolution));
  const auto down = static_cast<int>(std::lround((b.geo.north - a.geo.north) / a.geo.resolution));
  int both = 0;
  int same = 0;
  for (int row = 0; row < a.height(); ++row)
    for (int column = 0; column < a.width(); ++column) {
      if (!b.image.contains(column + right, row + down)) continue;
      if (a.valid.at(column, row) == 0 || b.valid.at(column + right, row + down) == 0) continue;
      ++both;
      bool equal = true;
      for (int k = 0; k < 3; ++k)
        equal = equal && a.image.at(column, row, k) == b.image.at(column + right, row + down, k);
      same += equal ? 1 : 0;
    }
  return both > 0 ? static_cast<double>(same) / both : 0.0;
}

TEST(Follow, GrowsWithEveryPhotoAndEndsAsTheWholeMap) {
  const fs::path folder = scratch_folder() / "follow";
  const auto photos = write_flight(folder / "photos", {.strips = 2, .photos = 3});
  fs::create_directories(folder / "incoming");
  const fs::path map = folder / "live.tif";
  const fs::path update = folder / "live.update.json";
  NadirProcess process(
      with_quick({"map", (folder / "incoming").string(), "-o", map.string(), "--follow", "--json",
                  "--photos", std::to_string(photos.size())}));
  GeoReference first;
  for (std::size_t i = 0; i < photos.size(); ++i) {
    if (i == 3) {  // a transfer that stops halfway, and then goes on
      const std::string bytes = read_file(photos[i]);
      const fs::path arriving = folder / "incoming" / photos[i].filename();
      write_file_as(arriving, bytes.substr(0, bytes.size() / 2));
      ASSERT_TRUE(says(process, "cut off"));
      write_file_as(arriving, bytes);
    } else {
      drop(photos[i], folder / "incoming");
    }
    const int version = static_cast<int>(i) + 1;
    const Json document = wait_for(update, version);
    ASSERT_TRUE(document.is_object()) << process.errors_so_far();
    EXPECT_EQ(document["version"], version);
    EXPECT_EQ(document["photos"], version);
    EXPECT_EQ(document["final"], false);
    EXPECT_EQ(document["provisional"], i == 0);
    EXPECT_FALSE(document["changed_tiles"].empty());
    const Orthomosaic ortho = read_orthomosaic(map);
    EXPECT_EQ(document["width_px"], ortho.width());
    if (i == 0) first = ortho.geo;
    const double columns = (ortho.geo.west - first.west) / first.resolution;
    EXPECT_NEAR(columns, std::round(columns), 1e-3);
  }
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  const Json last = Json::parse(read_file(update));
  EXPECT_EQ(last["final"], true);
  EXPECT_EQ(last["version"], 7);
  EXPECT_EQ(Json::parse(outcome.output)["registered"], 6);
  EXPECT_TRUE(fs::exists(folder / "live.report.html"));

  const fs::path batch = folder / "batch.tif";
  const Outcome again =
      nadir(with_quick({"map", (folder / "photos").string(), "-o", batch.string(), "-q"}));
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_GT(same_share(read_orthomosaic(map), read_orthomosaic(batch)), 0.999);
}

TEST(Follow, AnInterruptEndsItWithTheMapAsItStands) {
  const fs::path folder = scratch_folder() / "follow_interrupted";
  const auto photos = write_flight(folder / "photos", {.strips = 1, .photos = 2});
  fs::create_directories(folder / "incoming");
  const fs::path map = folder / "live.tif";
  NadirProcess process(with_quick(
      {"map", (folder / "incoming").string(), "-o", map.string(), "--follow", "--json"}));
  for (const fs::path& photo : photos) drop(photo, folder / "incoming");
  ASSERT_TRUE(wait_for(folder / "live.update.json", 2).is_object());
  process.interrupt();
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(
      Json::parse(outcome.output),
      (Json{
          {"map", map.string()}, {"photos", 2}, {"adjusted", false}, {"doubtful", Json::array()}}));
  const Json last = Json::parse(read_file(folder / "live.update.json"));
  EXPECT_EQ(last["final"], true);
  EXPECT_EQ(last["width_px"], read_orthomosaic(map).width());
}

TEST(Follow, EndsByItselfAndSaysWhereNothingCame) {
  const fs::path folder = scratch_folder() / "follow_nothing";
  fs::create_directories(folder / "incoming");
  const Outcome outcome = nadir({"map", (folder / "incoming").string(), "-o",
                                 (folder / "map.tif").string(), "--follow", "--idle", "0.5"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_NE(outcome.errors.find("no photo came"), std::string::npos) << outcome.errors;
}

TEST(Mapping, PartsThatDoNotMeetAreNamedAndDoubtfulUnlessAllowed) {
  const fs::path folder = scratch_folder() / "parts";
  test::FlightPlan plan{.strips = 2, .photos = 3, .middle = {-35.0, -20.0}};
  write_flight(folder / "photos", plan);
  plan = {.strips = 2, .photos = 2, .middle = {38.0, 20.0}, .prefix = "q"};
  write_flight(folder / "photos", plan);
  std::vector<std::string> arguments = with_quick(
      {"map", (folder / "photos").string(), "-o", (folder / "map.tif").string(), "--json"});
  Outcome outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, 5);
  for (const char* part : {"q100.jpg, q101.jpg, q102.jpg, q103.jpg do not join p100.jpg",
                           "--allow-parts", "4 of 10 photos do not join"}) {
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << part << " in:\n" << outcome.errors;
  }
  const Json document = Json::parse(outcome.output);
  ASSERT_EQ(document["components"].size(), 2U);
  EXPECT_EQ(document["components"][0].size(), 6U);
  EXPECT_EQ(document["components"][1].size(), 4U);
  EXPECT_EQ(document["registered"], 6);
  EXPECT_TRUE(fs::exists(folder / "map.tif")) << "the larger part is written";
  arguments.insert(arguments.end(), {"--allow-parts", "--overwrite"});
  outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
}

}  // namespace
}  // namespace nadir::testing
