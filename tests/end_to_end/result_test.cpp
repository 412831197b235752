// SPDX-License-Identifier: Apache-2.0
// What the verbs give on good input: one JSON document each, the same bytes for the same seed, and
// partial results after an interrupt.

#include <gtest/gtest.h>

#include <chrono>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <thread>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_site.hpp"
#include "nadir/io/maps/elevation_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Runs with --json and parses the whole of standard output.
Json json_of(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const Outcome outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << arguments.front() << ": " << outcome.errors;
  Json document = Json::parse(outcome.output, nullptr, false);
  EXPECT_FALSE(document.is_discarded()) << arguments.front() << ": " << outcome.output;
  return document;
}

std::string scratch(const std::string& name) { return (scratch_folder() / name).string(); }

TEST(ResultTest, ServiceVerbsGiveOneDocument) {
  EXPECT_TRUE(json_of({"version"}).contains("libraries"));
  EXPECT_TRUE(json_of({"config", "dump"}).contains("map_matching.score"));
  EXPECT_TRUE(json_of({"completion", "bash"}).contains("script"));
  EXPECT_EQ(json_of({"doctor"})["healthy"], true);
}

TEST(ResultTest, InfoOfEveryKind) {
  const Json site = json_of({"info", small_site().string()});
  EXPECT_EQ(site["kind"], "site");
  EXPECT_EQ(site["local_maps"]["count"], kSmallSiteFrames);
  EXPECT_EQ(site["truth"]["poses"], kSmallSiteFrames);
  const Json map = json_of({"info", map_file(small_site()).string()});
  EXPECT_EQ(map["kind"], "orthomosaic");
  EXPECT_EQ(map["resolution_m"], site["map"]["resolution_m"]);
  const std::string surface_file = scratch("info") + "_surface.tif";
  ElevationMap heights{Raster<float>(4, 3, 7.0F), {10.0, 20.0, 0.5, {}}};
  heights.height_m.at(0, 0) = 5.0F;
  heights.height_m.at(3, 2) = std::numeric_limits<float>::quiet_NaN();
  write_elevation_map(surface_file, heights);
  const Json surface = json_of({"info", surface_file});
  EXPECT_EQ(surface["kind"], "surface");
  EXPECT_EQ(surface["heights_m"]["lowest"], 5.0);
  EXPECT_EQ(surface["heights_m"]["median"], 7.0);
  EXPECT_EQ(surface["extent_m"]["south"], 18.5);
  EXPECT_NEAR(surface["known_share"], 11.0 / 12.0, 1e-12);
  const Json truth = json_of({"info", (small_site() / "truth.tum").string()});
  EXPECT_EQ(truth["kind"], "trajectory");
  EXPECT_GT(truth["length_m"], 1.0);
}

TEST(ResultTest, MatchFindsTheFrameWithEveryScore) {
  const std::string out = scratch("match");
  const Json document = json_of({"match", small_site().string(), "--frame", "4", "--window", "6",
                                 "--all-scores", "-o", out, "-q"});
  EXPECT_EQ(document["matches"].size(), 7U);
  for (const Json& match : document["matches"]) {
    if (match["score"] == "zwncc") {
      EXPECT_LT(match["candidates"][0]["error_m"], 0.5);
    }
    EXPECT_TRUE(fs::exists(fs::path(out) / match["heat_map"].get<std::string>()));
  }
  EXPECT_EQ(Json::parse(read_file(fs::path(out) / "match.json")), document);
  EXPECT_TRUE(Json::parse(read_file(fs::path(out) / "manifest.json")).contains("inputs"));
}

TEST(ResultTest, LocalizeWritesARunThatEvalJudgesAlike) {
  const std::string run = scratch("run");
  const Json document = json_of(
      {"localize", small_site().string(), "-o", run, "--prior", "truth", "--prior-spread", "1,2"});
  EXPECT_EQ(document["frames"], kSmallSiteFrames);
  for (const char* file : {"trajectory.tum", "covariance.csv", "frames.csv", "timing.csv",
                           "manifest.json", "trajectory.png", "swarm.png", "error.png",
                           "comparison.png", "coverage.png", "truth.tum", "report.html"}) {
    EXPECT_TRUE(fs::exists(fs::path(run) / file)) << file;
  }
  const Json judged =
      json_of({"eval", run + "/trajectory.tum", "--truth", (small_site() / "truth.tum").string()});
  EXPECT_EQ(judged["frames"], kSmallSiteFrames);
  EXPECT_EQ(judged["unanswered"], 0);
  EXPECT_EQ(judged["alignment"], "none");
  EXPECT_TRUE(judged.contains("nees"));
  EXPECT_NEAR(judged["ape_trans_m"]["rmse"], document["evaluation"]["ape_trans_m"]["rmse"], 1e-6);
  EXPECT_LT(judged["ape_trans_m"]["rmse"], 1.0);

  const Json part = json_of({"eval", run + "/trajectory.tum", "--truth",
                             (small_site() / "truth.tum").string(), "--frames", "2:4"});
  EXPECT_EQ(part["frames"], 3);
}

TEST(ResultTest, AReportIsWrittenAnewAndElsewhere) {
  const std::string run = scratch("reported");
  EXPECT_EQ(
      nadir({"localize", small_site().string(), "-o", run, "--prior", "truth", "-q"}).exit_code, 0);
  const std::string first = read_file(fs::path(run) / "report.html");
  EXPECT_NE(first.find("8 of 8 frames compared"), std::string::npos);
  EXPECT_EQ(json_of({"report", run})["report"], run + "/report.html");
  EXPECT_EQ(read_file(fs::path(run) / "report.html"), first);
  const std::string page = scratch("page.html");
  const Json written = json_of({"report", run, "-o", page});
  EXPECT_EQ(written["bytes"], fs::file_size(page));
  EXPECT_NE(nadir({"report", run, "-o", page}).exit_code, 0);
  EXPECT_EQ(nadir({"report", run, "-o", page, "--overwrite"}).exit_code, 0);
}

TEST(ResultTest, AStartAtTheTruthBeginsWhereTheTruthDoes) {
  const fs::path site = copy_of_small_site("late_truth");
  const std::string truth = read_file(site / "truth.tum");
  std::size_t third = 0;
  for (int line = 0; line < 3; ++line) third = truth.find('\n', third) + 1;  // and the comment
  std::ofstream(site / "truth.tum") << truth.substr(third);
  const std::vector<std::string> arguments = {
      "localize", site.string(), "-o", scratch("late"), "--prior", "truth", "--dry-run"};
  EXPECT_EQ(json_of(arguments)["frames"], kSmallSiteFrames - 2);
  std::vector<std::string> named = arguments;
  named.insert(named.end(), {"--frames", "0:100"});
  EXPECT_EQ(json_of(named)["frames"], kSmallSiteFrames);
}

TEST(ResultTest, SeveralSeedsGiveMeanAndSpread) {
  const std::string run = scratch("seeds");
  const Json document = json_of({"localize", small_site().string(), "-o", run, "--prior", "truth",
                                 "--prior-spread", "1,2", "--seed", "4", "--seeds", "2"});
  EXPECT_EQ(document["summary"]["seeds"], 2);
  EXPECT_TRUE(fs::exists(fs::path(run) / "seed_4" / "trajectory.tum"));
  EXPECT_NE(read_file(fs::path(run) / "seed_4" / "trajectory.tum"),
            read_file(fs::path(run) / "seed_5" / "trajectory.tum"));
}

TEST(ResultTest, SameSeedSameBytesForAnyNumberOfThreads) {
  const auto localize = [](const std::string& name, const std::string& threads) {
    const Outcome outcome =
        nadir({"localize", small_site().string(), "-o", scratch(name), "--prior", "truth",
               "--odometry", "maps", "--seed", "9", "--threads", threads, "-q"});
    // The local maps of this site are small: registered from them alone the robot is lost.
    EXPECT_EQ(outcome.exit_code, 5) << outcome.errors;
  };
  localize("one_thread", "1");
  localize("two_threads", "2");
  localize("again", "2");
  for (const char* file : {"trajectory.tum", "covariance.csv", "frames.csv"}) {
    const std::string expected = read_file(scratch_folder() / "one_thread" / file);
    EXPECT_FALSE(expected.empty()) << file;
    EXPECT_EQ(expected, read_file(scratch_folder() / "two_threads" / file)) << file;
    EXPECT_EQ(expected, read_file(scratch_folder() / "again" / file)) << file;
  }
}

TEST(ResultTest, InterruptKeepsWhatWasDone) {
  const std::string run = scratch("interrupted");
  NadirProcess process({"localize", small_site().string(), "-o", run, "--prior", "truth", "--seeds",
                        "20", "--particles", "3000", "--progress", "lines"});
  // The first line of progress comes after two of the seeds.
  for (int i = 0; i < 600 && process.errors_so_far().find(" % ") == std::string::npos; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  process.interrupt();
  const Outcome outcome = process.wait();
  EXPECT_EQ(outcome.exit_code, 130) << outcome.errors;
  EXPECT_NE(read_file(fs::path(run) / "manifest.json").find("interrupted"), std::string::npos);
  EXPECT_TRUE(fs::exists(fs::path(run) / "seed_7" / "trajectory.tum"));
}

}  // namespace
}  // namespace nadir::testing
