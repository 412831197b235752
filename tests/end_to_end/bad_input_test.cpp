// SPDX-License-Identifier: Apache-2.0
// Every bad input is one clear line, the right exit code, and nothing half-written.

#include <gtest/gtest.h>

#include <algorithm>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_site.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;

class BadInputTest : public ::testing::Test {
 protected:
  BadInputTest() {
    fs::remove_all(place_);
    fs::create_directories(place_);
  }

  Outcome localize(const fs::path& site, std::vector<std::string> more = {}) const {
    std::vector<std::string> arguments{"localize", site.string(), "-o", run(), "--prior", "truth"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return nadir(arguments);
  }

  std::string run() const { return (place_ / "run").string(); }

  void expect_refused(const Outcome& outcome, int exit_code, const std::string& part) const {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    EXPECT_NE(outcome.errors.find("nadir: error: "), std::string::npos) << outcome.errors;
    EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
    EXPECT_EQ(outcome.output, "");
    const std::string last = outcome.errors.substr(outcome.errors.find("nadir: error: "));
    EXPECT_EQ(std::ranges::count(last, '\n'), 1) << outcome.errors;
    // No output, and no temporary of one.
    EXPECT_TRUE(fs::is_empty(place_)) << fs::directory_iterator(place_)->path();
  }

  fs::path place_ = scratch_folder() / "place";
};

TEST_F(BadInputTest, MissingSite) {
  expect_refused(localize("no/such/site"), 3, "no/such/site");
  expect_refused(nadir({"info", "no/such/file.tif"}), 3, "no/such/file.tif");
  expect_refused(nadir({"convert", "aeroground", "no/such", "-o", run()}), 3, "no/such");
  expect_refused(nadir({"eval", "no.tum", "--truth", "no.tum"}), 3, "no.tum");
}

TEST_F(BadInputTest, WhatIsNoRunHasNoReport) {
  const std::string page = (place_ / "page.html").string();
  expect_refused(nadir({"report", "no/such/run", "-o", page}), 3, "no/such/run");
  expect_refused(nadir({"report", small_site().string(), "-o", page}), 3, "manifest.json");
  expect_refused(nadir({"report", "no/such/map.tif", "-o", page}), 3, "map.tif");
  expect_refused(nadir({"report", map_file(small_site()).string(), "-o", page}), 3,
                 "no page beside it");
  const std::string there = (small_site() / "sequence.yaml").string();
  expect_refused(nadir({"report", "any", "-o", there}), 2, "--overwrite");
}

TEST_F(BadInputTest, FolderWithoutData) {
  const fs::path empty = scratch_folder() / "empty_folder";
  fs::create_directories(empty);
  expect_refused(localize(empty), 3, "sequence.yaml");
  expect_refused(nadir({"convert", "aeroground", empty.string(), "-o", run()}), 3, "empty_folder");
}

TEST_F(BadInputTest, TruncatedGlobalMap) {
  const fs::path site = copy_of_small_site("truncated_map");
  fs::resize_file(map_file(site), 300);
  expect_refused(localize(site), 3, map_file(site).filename().string());
}

TEST_F(BadInputTest, TruncatedLocalMap) {
  const fs::path site = copy_of_small_site("truncated_local");
  const fs::path image = local_map_file(site, 3);
  fs::resize_file(image, fs::file_size(image) / 2);
  expect_refused(localize(site), 3, image.filename().string());
}

TEST_F(BadInputTest, MissingLocalMap) {
  const fs::path site = copy_of_small_site("missing_local");
  const fs::path image = local_map_file(site, 2);
  fs::remove(image);
  expect_refused(localize(site), 3, image.filename().string());
}

TEST_F(BadInputTest, NotFiniteOdometry) {
  const fs::path site = copy_of_small_site("nan_odometry");
  std::string text = read_file(site / "odometry.tum");
  const std::size_t line = text.find('\n', text.size() / 2) + 1;
  text.replace(text.find(' ', line) + 1, 1, "nan ");
  write_file_as(site / "odometry.tum", text);
  expect_refused(localize(site), 3, "odometry.tum:");
}

TEST_F(BadInputTest, EmptySequence) {
  const fs::path site = copy_of_small_site("empty_sequence");
  std::string text = read_file(site / "sequence.yaml");
  text = text.substr(0, text.find("local_maps")) + "local_maps: []\n";
  write_file_as(site / "sequence.yaml", text);
  expect_refused(localize(site), 3, "sequence.yaml");
}

TEST_F(BadInputTest, EmptyOrBrokenTrajectories) {
  const fs::path file = scratch_folder() / "trajectory.tum";
  const std::string truth = (small_site() / "truth.tum").string();
  write_file_as(file, "# nothing\n");
  EXPECT_EQ(nadir({"eval", file.string(), "--truth", truth}).exit_code, 3);
  write_file_as(file, "0 1 2 0 0 0 0 1\n1 1 2 0 0\n");
  expect_refused(nadir({"eval", file.string(), "--truth", truth}), 3, "trajectory.tum:2");
  write_file_as(file, "1 1 2 0 0 0 0 1\n1 1 2 0 0 0 0 1\n");
  expect_refused(nadir({"eval", file.string(), "--truth", truth}), 3, "trajectory.tum:2");
}

TEST_F(BadInputTest, MapOfAnotherPlaceIsNoResult) {
  // The site is fine, but its start lies far outside the map.
  const Outcome outcome =
      nadir({"localize", small_site().string(), "-o", run(), "--prior", "100000,100000,0", "-q"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.errors;
  EXPECT_NE(outcome.errors.find("no local map could be compared"), std::string::npos);
}

TEST_F(BadInputTest, TemplateThatIsAllHoles) {
  const fs::path site = copy_of_small_site("all_holes");
  const fs::path image = local_map_file(site, 3);
  Orthomosaic local = read_orthomosaic(image);
  std::ranges::fill(local.valid.values(), std::uint8_t{0});
  write_orthomosaic(image, local);
  const Outcome outcome = nadir({"match", site.string(), "--frame", "3", "-o", run(), "-q"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.errors;
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
  // One blind frame does not stop a run.
  fs::remove_all(run());
  const Outcome whole = localize(site, {"-q"});
  EXPECT_EQ(whole.exit_code, 0) << whole.errors;
  EXPECT_NE(read_file(fs::path(run()) / "frames.csv").find("\n3,"), std::string::npos);
}

TEST_F(BadInputTest, TemplateLargerThanTheMap) {
  const fs::path site = copy_of_small_site("large_template");
  Orthomosaic local = read_orthomosaic(local_map_file(site, 0));
  Orthomosaic map = read_orthomosaic(map_file(site));
  const int side = local.width() / 2;
  Orthomosaic small{Raster<std::uint8_t>(side, side, 100, map.image.channels()),
                    Raster<std::uint8_t>(side, side, 1), map.geo};
  write_orthomosaic(scratch_folder() / "small_map.tif", small);
  const Outcome outcome = nadir({"match", site.string(), "--frame", "0", "--map",
                                 (scratch_folder() / "small_map.tif").string(), "-o", run(), "-q"});
  EXPECT_EQ(outcome.exit_code, 4) << outcome.errors;
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
}

TEST_F(BadInputTest, ExistingOutputIsRefusedAndReplacedOnlyIfOurs) {
  fs::create_directories(run());
  write_file_as(fs::path(run()) / "thesis.txt", "years of work");
  const Outcome refused = localize(small_site());
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.errors.find("--overwrite"), std::string::npos);
  const Outcome foreign = localize(small_site(), {"--overwrite"});
  EXPECT_EQ(foreign.exit_code, 2);
  EXPECT_NE(foreign.errors.find("was not written by nadir"), std::string::npos);
  EXPECT_EQ(read_file(fs::path(run()) / "thesis.txt"), "years of work");

  fs::remove(fs::path(run()) / "thesis.txt");
  EXPECT_EQ(localize(small_site(), {"-q"}).exit_code, 0);
  EXPECT_EQ(localize(small_site(), {"-q"}).exit_code, 2);
  EXPECT_EQ(localize(small_site(), {"-q", "--overwrite"}).exit_code, 0);
}

TEST_F(BadInputTest, OutputOverItsOwnInputIsRefused) {
  const fs::path site = copy_of_small_site("own_input");
  const Outcome outcome =
      nadir({"localize", site.string(), "-o", site.string(), "--prior", "truth", "--overwrite"});
  EXPECT_EQ(outcome.exit_code, 2);
  EXPECT_TRUE(fs::exists(site / "sequence.yaml"));
}

TEST_F(BadInputTest, DryRunWritesNothing) {
  const Outcome outcome = localize(small_site(), {"--dry-run"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_TRUE(fs::is_empty(place_));
}

}  // namespace
}  // namespace nadir::testing
