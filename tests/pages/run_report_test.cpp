// SPDX-License-Identifier: Apache-2.0
#include "run_report.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "nadir/io/image.hpp"
#include "nadir/io/provenance/manifest.hpp"
#include "page_check.hpp"
#include "run_files.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;
using test::expect_error;
using testing::foreign_part;
using testing::markup_fault;

RunResult result_of(double offset) {
  RunResult result;
  for (int i = 0; i < 12; ++i) {
    FrameRecord record;
    record.number = i;
    record.estimate.stamp = Stamp{1'700'000'000'000'000'000LL + i * 500'000'000LL};
    record.estimate.map_from_robot = {10.0 + i + offset, 20.0, 0.1};
    record.estimate.covariance = PoseCovariance::Identity() * 0.04;
    record.estimate.effective_particles = 500.0 - i;
    record.estimate.best_score = 0.8;
    record.decode_s = 0.001;
    record.update_s = 0.02 + 0.001 * i;
    if (i == 5) record.estimate.status = EstimateStatus::kNoOverlap;
    result.records.push_back(record);
  }
  return result;
}

Trajectory truth_of(const RunResult& result, double offset) {
  Trajectory truth = result.trajectory();
  for (auto& stamped : truth) stamped.pose.x -= offset;
  return truth;
}

void write_small_run(const fs::path& folder, double offset, bool with_truth) {
  const RunResult result = result_of(offset);
  write_run(folder, result, with_truth ? truth_of(result, offset) : Trajectory{});
}

void write_small_manifest(const fs::path& folder, const std::string& argument = "--set a&b<c>") {
  Manifest manifest;
  manifest.program_version = "0.0.1";
  manifest.arguments = {"localize", "site", argument};
  manifest.stages = {{"localize", 1.5}};
  test::write_text(folder / "input.txt", "input");
  manifest.inputs = {folder / "input.txt"};
  LocalizerOptions options;
  const OptionTable table = option_table(options);
  table.find("localization.particles")->set("1234");
  write_manifest(folder, manifest, table, {{"localization.particles", "--particles"}});
}

TEST(RunReport, ThePageIsWellFormedAndKeepsToItself) {
  const test::TemporaryFolder folder;
  write_small_run(folder.path(), 0.3, true);
  write_small_manifest(folder.path());
  write_png(folder / "trajectory.png", Raster<std::uint8_t>(8, 8, 100, 3));
  const fs::path page = write_run_report(folder.path());
  EXPECT_EQ(page, folder / "report.html");
  const std::string text = test::read_text(page);
  EXPECT_EQ(markup_fault(text), "");
  EXPECT_EQ(foreign_part(text), "");
  for (const char* part :
       {"Localized well: 11 of 12 frames", "APE position, m", "0.300", "NEES",
        "too little of the local map", "localization.particles", "1234", "--particles",
        "a&amp;b&lt;c&gt;", "data:image/png;base64,", "Error and uncertainty over time",
        // of "input"
        "c96c6d5be8d08a12e7b5cdc1b207fa6b2430974c86803d8891675e76fd992c20"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(text.find("--set a&b"), std::string::npos);
}

TEST(RunReport, ALargePictureBecomesASmallerOne) {
  const test::TemporaryFolder folder;
  write_small_run(folder.path(), 0.3, true);
  write_small_manifest(folder.path());
  Raster<std::uint8_t> noise(500, 500, 0, 3);
  std::uint32_t state = 1;
  for (std::uint8_t& value : noise.values()) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<std::uint8_t>(state >> 24U);
  }
  write_png(folder / "swarm.png", noise);
  ASSERT_GT(fs::file_size(folder / "swarm.png"), 300'000U);
  const std::string text = test::read_text(write_run_report(folder.path()));
  EXPECT_NE(text.find("data:image/jpeg;base64,"), std::string::npos);
  EXPECT_LT(text.size(), fs::file_size(folder / "swarm.png"));
}

TEST(RunReport, WithoutATruthThereIsNoAccuracy) {
  const test::TemporaryFolder folder;
  write_small_run(folder.path(), 0.3, false);
  write_small_manifest(folder.path());
  const std::string text = test::read_text(write_run_report(folder.path()));
  EXPECT_EQ(markup_fault(text), "");
  EXPECT_NE(text.find("No true trajectory"), std::string::npos);
  EXPECT_EQ(text.find("APE"), std::string::npos);
  EXPECT_NE(text.find("Uncertainty over time"), std::string::npos);
}

TEST(RunReport, ATruthThatDoesNotFitIsSaidAndLeftOut) {
  const test::TemporaryFolder folder;
  write_small_run(folder.path(), 0.3, true);
  write_small_manifest(folder.path());
  test::write_text(folder / "truth.tum", "1700000000.0 nonsense\n");
  const std::string text = test::read_text(write_run_report(folder.path()));
  EXPECT_NE(text.find("The truth could not be used"), std::string::npos);
  EXPECT_EQ(text.find("APE"), std::string::npos);
}

TEST(RunReport, SeedsAreComparedAndTheFirstIsShown) {
  const test::TemporaryFolder folder;
  write_small_run(folder / "seed_9", 0.3, true);
  write_small_run(folder / "seed_10", 3.0, true);
  write_small_manifest(folder.path());
  const std::string text = test::read_text(write_run_report(folder.path()));
  EXPECT_EQ(markup_fault(text), "");
  EXPECT_EQ(foreign_part(text), "");
  EXPECT_LT(text.find("seed_9"), text.find("seed_10"));
  EXPECT_NE(text.find("The first of them: seed_9"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder / "seed_9" / "report.html"));
}

TEST(RunReport, RunsOfADemoHavePagesOfTheirOwn) {
  const test::TemporaryFolder folder;
  for (const char* run : {"run", "run_ncc"}) {
    write_small_run(folder / run, 0.3, true);
    write_small_manifest(folder / run);
  }
  write_small_manifest(folder.path());
  const std::string text = test::read_text(write_run_report(folder.path()));
  EXPECT_EQ(markup_fault(text), "");
  EXPECT_NE(text.find("<a href=\"run_ncc/report.html\">run_ncc</a>"), std::string::npos);
  EXPECT_TRUE(fs::exists(folder / "run_ncc" / "report.html"));
  write_run_report(folder.path(), folder / "elsewhere.html");
  EXPECT_EQ(test::read_text(folder / "elsewhere.html").find("<a href"), std::string::npos);
}

TEST(RunReport, WhatIsNoRunIsSaidInOneLine) {
  const test::TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"no such folder", "nowhere"},
               [&] { write_run_report(folder / "nowhere"); });
  expect_error(ErrorKind::kInput, {"holds no manifest.json"},
               [&] { write_run_report(folder.path()); });
  test::write_text(folder / "manifest.json", "{ half");
  expect_error(ErrorKind::kInput, {"manifest.json", "is not JSON"},
               [&] { write_run_report(folder.path()); });
  write_small_manifest(folder.path());
  expect_error(ErrorKind::kInput, {"holds no trajectory.tum"},
               [&] { write_run_report(folder.path()); });
  EXPECT_FALSE(fs::exists(folder / "report.html"));
}

/// An item of another kind than is expected, and brackets that no stack holds.
TEST(RunReport, AManifestThatWasEditedIsSaidWithWhatIsWrong) {
  const test::TemporaryFolder folder;
  const int deep = 200'000;
  const std::string brackets = std::string(deep, '[') + std::string(deep, ']');
  for (const auto& [text, problem] :
       {std::pair<std::string, const char*>{R"({"options": [1]})", "'options' is no object"},
        {R"({"options": {"a": {"value": )" + brackets + "}}}", "nested too deeply"},
        {R"({"sources": {"site": 5}})", "'site' is no path"},
        {R"({"sources": {"map": ")" + std::string(5000, 'a') + "\"}}", "File name too long"},
        {R"({"stages": [{"seconds": "1"}]})", "'seconds' is no number"},
        {R"({"inputs": [5]})", "'path' is no object"},
        {R"({"seed": -1})", "'seed' is no whole number"},
        {R"({"host": 5})", "'host' is no object"}}) {
    test::write_text(folder / "manifest.json", text);
    expect_error(ErrorKind::kInput, {"manifest.json", problem},
                 [&] { write_run_report(folder.path()); });
  }
}

TEST(RunReport, HalfARunIsSaidWithTheFileThatIsMissing) {
  const test::TemporaryFolder folder;
  write_small_run(folder.path(), 0.3, true);
  write_small_manifest(folder.path());
  fs::remove(folder / "timing.csv");
  expect_error(ErrorKind::kInput, {"timing.csv"}, [&] { write_run_report(folder.path()); });
  write_small_run(folder.path(), 0.3, true);
  test::write_text(folder / "frames.csv", "frame,stamp_s,status\n1,2\n");
  expect_error(ErrorKind::kInput, {"frames.csv:2"}, [&] { write_run_report(folder.path()); });
}

}  // namespace
}  // namespace nadir::cli
