// SPDX-License-Identifier: Apache-2.0
// Files and folders of every name that Linux allows go in and come out; JSON stays JSON.
// mapping_endings_test.cpp does the same of photos and their map.

#include <gtest/gtest.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "end_to_end/endings.hpp"
#include "end_to_end/nadir_process.hpp"
#include "end_to_end/odd_names.hpp"
#include "end_to_end/small_drive.hpp"
#include "end_to_end/small_site.hpp"
#include "nadir/io/file_names.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// A folder with everything of an odd name in it: inputs here, outputs to come.
class Names : public ::testing::TestWithParam<OddName> {
 protected:
  Names() {
    fs::remove_all(place_);
    fs::create_directories(place_);
  }
  ~Names() override { fs::remove_all(place_); }

  /// A file or folder whose name is odd, ends so, and begins with a letter of its own.
  fs::path odd(char letter, const std::string& ending = {}) const {
    return place_ / GetParam().with(letter, ending);
  }
  /// Nothing hidden is left beside the outputs.
  void expect_no_remains() const {
    for (const auto& entry : fs::directory_iterator(place_)) {
      EXPECT_FALSE(entry.path().filename().string().starts_with('.')) << entry.path();
    }
  }

  fs::path place_ = scratch_folder() / "odd_names";
};

INSTANTIATE_TEST_SUITE_P(Odd, Names, ::testing::ValuesIn(kOddNames),
                         [](const auto& odd) { return odd.param.label; });

TEST_P(Names, ASiteIsReadMatchedLocalizedJudgedAndShown) {
  const fs::path site = odd('s');
  fs::copy(small_site(), site, fs::copy_options::recursive);
  const std::string run = odd('r');
  const std::string match = odd('m');
  const std::string page = odd('p', ".html");
  expect_ending({"info", site}, 0);
  expect_ending({"match", site, "--frame", "4", "--window", "4", "-o", match, "-q"}, 0);
  expect_ending({"localize", site, "-o", run, "--prior", "truth", "-q"}, 0);
  expect_ending({"localize", site, "-o", run, "--prior", "truth", "-q", "--overwrite"}, 0);
  expect_ending({"eval", run + "/trajectory.tum", "--truth", site.string() + "/truth.tum"}, 0);
  expect_ending({"report", run}, 0);
  expect_ending({"report", run, "-o", page}, 0);
  EXPECT_EQ(read_file(page), read_file(run + "/report.html"));
  expect_ending({"info", site.string() + "/no such"}, 3);
  // The manifest says where the site is, byte by byte: the viewer finds it again.
  NadirProcess view({"view", run, "--port", "0", "--json"});
  view.send_when(SIGINT, "frames");
  const Outcome viewed = view.wait();
  EXPECT_EQ(viewed.exit_code, 0) << viewed.errors;
  EXPECT_EQ(Json::parse(viewed.output)["frames"], kSmallSiteFrames);
  expect_no_remains();
}

TEST_P(Names, ADriveIsMappedAndRun) {
  const fs::path drive = odd('d');
  fs::copy(small_drive(), drive, fs::copy_options::recursive);
  const fs::path map = odd('m', ".tif");
  fs::copy_file(small_drive_map(), map);
  const fs::path poses = odd('p', ".tum");
  fs::copy_file(drive / "odometry.tum", poses);
  const std::string site = odd('s');
  expect_ending({"ground", drive, "-o", site, "--poses", poses, "--map", map, "--count", "8", "-q"},
                0);
  EXPECT_EQ(expect_ending({"info", site}, 0).errors, "");
  expect_ending({"info", drive}, 0);
  expect_ending(
      {"run", drive, "--map", map, "-o", odd('r'), "--prior", "truth", "--count", "8", "--dry-run"},
      0);
  expect_no_remains();
}

TEST_P(Names, MapsAreConvertedAndOptionsRead) {
  const fs::path picture = odd('p', ".tif");
  fs::copy_file(map_file(small_site()), picture);
  const fs::path config = odd('c', ".yaml");
  write_file_as(config, "simulation:\n  width_m: 60\n  depth_m: 50\n");
  expect_ending({"convert", "map", picture, "-o", odd('m', ".tif"), "--gsd", "0.2"}, 0);
  expect_ending({"info", odd('m', ".tif")}, 0);
  expect_ending({"config", "dump", "--config", config}, 0);
  const Json demo = Json::parse(expect_ending({"demo", "-o", odd('d'), "--dry-run"}, 0).output);
  EXPECT_EQ(demo["commands"][0].get<std::string>().find("nadir simulate -o"), 0U);
  expect_no_remains();
}

TEST(DashNames, FollowTwoDashesOrAnEqualsSign) {
  const fs::path place = scratch_folder() / "dashes";
  fs::create_directories(place);
  fs::copy(small_site(), place / "-site", fs::copy_options::recursive);
  EXPECT_EQ(nadir_in(place, {"info", "--json", "--", "-site"}).exit_code, 0);
  const Outcome run = nadir_in(
      place, {"localize", "--output=-run", "--prior", "truth", "-q", "--json", "--", "-site"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_TRUE(fs::exists(place / "-run" / "report.html"));
  EXPECT_EQ(nadir_in(place, {"report", "--json", "--", "-run"}).exit_code, 0);
  EXPECT_EQ(nadir_in(place,
                     {"convert", "map", "--output=-map.tif", "--gsd", "0.2", "--", "-site/map.tif"})
                .exit_code,
            0);
}

TEST(LongNames, AMapLeavesRoomForItsSisters) {
  const fs::path place = scratch_folder() / "long_names";
  const std::string name(kLongestName - 4, 'm');
  const Outcome outcome = expect_ending(
      {"map", small_site().string(), "-o", (place / (name + ".tif")).string(), "--dry-run"}, 2);
  EXPECT_NE(outcome.errors.find("at most 243 bytes"), std::string::npos) << outcome.errors;
}

}  // namespace
}  // namespace nadir::testing
