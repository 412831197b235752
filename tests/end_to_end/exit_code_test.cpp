// SPDX-License-Identifier: Apache-2.0
// Every verb through its endings: the exit code of the one table (docs/exit-codes.md), and with
// --json exactly one document, however it ends. `nadir map` and `demo` have theirs in
// mapping_endings_test.cpp and demo_test.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>

#include "end_to_end/endings.hpp"
#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_drive.hpp"
#include "end_to_end/small_site.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/pose_file.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

std::string place_of(const std::string& name) { return (scratch_folder() / name).string(); }

Words operator+(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A place that nothing can be written into, whoever asks.
const std::string kNowhere = "/proc/nadir";

Words localize(const std::string& run) {
  return {"localize", small_site().string(), "-o", run, "--prior", "truth", "--overwrite", "-q"};
}

TEST(ExitCode, ServiceVerbs) {
  expect_ending({"version"}, 0);
  expect_ending({"--version"}, 0);
  expect_ending({"doctor"}, 0);
  expect_ending({"completion", "bash"}, 0);
  expect_ending({"completion", "tcsh"}, 2);
  expect_ending({"config", "dump"}, 0);
  expect_ending({"config", "dump", "--set", "no.such=1"}, 2);
  expect_ending({"config", "dump", "--config", "no/such.yaml"}, 3);
  expect_ending({"lokalize"}, 2);
  expect_ending({"config", "dmp"}, 2);
  expect_ending({}, 2);  // --json alone is no verb
  expect_ending({"version", "--no-such-option"}, 2);
}

TEST(ExitCode, HelpIsTextAndTellsTheTable) {
  const Outcome help = nadir({"--help"});
  EXPECT_EQ(help.exit_code, 0);
  EXPECT_NE(help.output.find("5 result doubtful"), std::string::npos) << help.output;
  EXPECT_EQ(nadir({"map", "--help", "--json"}).exit_code, 0);
}

TEST(ExitCode, Info) {
  expect_ending({"info", small_site().string()}, 0);
  expect_ending({"info"}, 2);
  expect_ending({"info", "no/such/place"}, 3);
  expect_ending({"info", "\xff"}, 3);
  expect_ending({"info", place_of(std::string(300, 'n'))}, 3);
}

TEST(ExitCode, NamesBehindTheDashesAreNoOptions) {
  const Outcome outcome = nadir({"info", "--", "--json"});
  EXPECT_EQ(outcome.exit_code, 3);
  EXPECT_EQ(outcome.output, "");
}

TEST(ExitCode, Simulate) {
  const Words small{"--set",     "simulation.width_m=60",
                    "--set",     "simulation.depth_m=50",
                    "--set",     "simulation.flight_image_width=400",
                    "--set",     "simulation.flight_image_height=300",
                    "--set",     "simulation.flight_focal_px=312",
                    "--photos",  "1",
                    "--frames",  "2",
                    "--sensors", "lidar",
                    "-q"};
  expect_ending(Words{"simulate", "-o", place_of("simulated \"caf\xe9\"\n")} + small, 0);
  expect_ending({"simulate", "-o", place_of("simulated"), "--gps", "none"}, 2);
  expect_ending({"simulate", "-o", place_of("simulated2"), "--from", "no/such.tif"}, 3);
  expect_ending(Words{"simulate", "-o", kNowhere} + small, 1);
}

TEST(ExitCode, Convert) {
  const std::string picture = place_of("picture.png");
  write_png(picture, Raster<std::uint8_t>(40, 30, 90, 3));
  const std::string map = place_of("converted.tif");
  const Words convert{"convert", "map", picture, "--metres-per-pixel", "0.5", "-o"};
  expect_ending(convert + Words{map}, 0);
  expect_ending(convert + Words{map}, 2);  // it is there
  expect_ending(convert + Words{kNowhere + "/map.tif"}, 1);
  expect_ending({"convert", "map", "no/such.png", "-o", place_of("other.tif")}, 3);
  expect_ending({"convert", "aeroground", "no/such", "-o", place_of("no_aeroground")}, 3);
  expect_ending(
      {"convert", "aeroground", place_of(""), "-o", place_of("no_aeroground"), "--dry-run"}, 0);
}

TEST(ExitCode, Match) {
  const std::string out = place_of("matched");
  const Words match{"match", small_site().string(), "-o", out, "--overwrite", "-q", "--frame"};
  const Words near{"4", "--window", "4"};
  expect_ending(match + near, 0);
  expect_ending(match + Words{"77"}, 2);
  expect_ending({"match", "no/such", "--frame", "4", "-o", place_of("unmatched")}, 3);
  expect_ending({"match", small_site().string(), "--frame", "4", "--window", "4", "-o", kNowhere},
                1);
  const Outcome ambiguous =
      expect_ending(match + near + Words{"--set", "map_matching.ambiguous_peak_ratio=0"}, 5);
  EXPECT_NE(ambiguous.errors.find("another place fits nearly as well"), std::string::npos);
  EXPECT_EQ(Json::parse(read_file(fs::path(out) / "match.json")), Json::parse(ambiguous.output));
  EXPECT_EQ(Json::parse(read_file(fs::path(out) / "manifest.json"))["doubtful"].size(), 1U);
  // It cannot find the true place, as it does not look there.
  const Outcome off = expect_ending(match + Words{"4", "--centre", "20,20", "--window", "3"}, 5);
  EXPECT_NE(off.errors.find("from the true one"), std::string::npos) << off.errors;

  const fs::path site = copy_of_small_site("match_holes");
  Orthomosaic local = read_orthomosaic(local_map_file(site, 4));
  std::ranges::fill(local.valid.values(), std::uint8_t{0});
  write_orthomosaic(local_map_file(site, 4), local);
  expect_ending({"match", site.string(), "--frame", "4", "-o", out, "--overwrite", "-q"}, 4);
}

TEST(ExitCode, Localize) {
  const std::string run = place_of("localized");
  expect_ending(localize(run), 0);
  expect_ending({"localize", small_site().string(), "-o", run, "--prior", "1,2"}, 2);
  expect_ending({"localize", "no/such", "-o", run, "--prior", "truth"}, 3);
  expect_ending({"localize", small_site().string(), "-o", kNowhere, "--prior", "truth", "-q"}, 1);
  expect_ending({"localize", small_site().string(), "-o", place_of("off_the_map"), "--prior",
                 "100000,100000,0", "-q"},
                4);
  const Outcome lost = expect_ending({"localize", small_site().string(), "-o", run, "--prior",
                                      "15,15,0", "--prior-spread", "0.5,1", "--overwrite", "-q"},
                                     5);
  EXPECT_NE(lost.errors.find("did not come to stay under 1 m"), std::string::npos) << lost.errors;
  EXPECT_FALSE(Json::parse(read_file(fs::path(run) / "manifest.json"))["doubtful"].empty());
  EXPECT_NE(read_file(fs::path(run) / "report.html").find("The error did not come to stay"),
            std::string::npos);
}

TEST(ExitCode, EvalAndReport) {
  const std::string run = place_of("judged");
  ASSERT_EQ(nadir(localize(run)).exit_code, 0);
  const std::string truth = (small_site() / "truth.tum").string();
  expect_ending({"eval", run + "/trajectory.tum", "--truth", truth}, 0);
  expect_ending({"eval", run + "/trajectory.tum"}, 2);
  expect_ending({"eval", "no.tum", "--truth", truth}, 3);
  // One of the poses has a truth at its time, the others lie between two.
  std::string shifted;
  for (const char* line : {"0 1 2 0 0 0 0 1", "0.5 1 2 0 0 0 0 1", "1.5 1 2 0 0 0 0 1",
                           "2.5 1 2 0 0 0 0 1", "3.5 1 2 0 0 0 0 1"}) {
    shifted += std::string(line) + "\n";
  }
  std::string whole;
  for (int i = 0; i < 6; ++i) whole += std::to_string(i) + " 1 2 0 0 0 0 1\n";
  write_file_as(place_of("shifted.tum"), shifted);
  write_file_as(place_of("whole.tum"), whole);
  const Outcome few =
      expect_ending({"eval", place_of("shifted.tum"), "--truth", place_of("whole.tum")}, 5);
  EXPECT_NE(few.errors.find("only 1 of its 5 poses"), std::string::npos) << few.errors;

  expect_ending({"report", run}, 0);
  expect_ending({"report", run, "-o", truth}, 2);
  expect_ending({"report", "no/such"}, 3);
}

TEST(ExitCode, GroundAndRun) {
  const std::string drive = small_drive().string();
  const std::string site = place_of("ground_site");
  const Words few{"--count", "5", "--overwrite", "-q"};
  const Words ground{"ground", drive, "-o", site};
  expect_ending(ground + few, 0);
  expect_ending(ground + Words{"--every", "0m"}, 2);
  expect_ending({"ground", "no/such", "-o", site}, 3);
  expect_ending({"ground", drive, "-o", kNowhere, "--count", "3", "-q"}, 1);

  const fs::path blind = copy_of_small_drive("blind_drive");
  for (const char* camera : {"image_0", "image_1"}) {
    for (const auto& entry : fs::directory_iterator(blind / camera)) {
      write_png(entry.path(), Raster<std::uint8_t>(320, 160, 90));
    }
  }
  expect_ending(Words{"ground", blind.string(), "-o", place_of("blind_site")} + few, 4);

  // Poses that are too short by more than half do not fit the images.
  std::vector<StampedOdomPose3> poses;
  for (int i = 0; i < kSmallDriveFrames; ++i) {
    OdomPose3 pose = small_drive_pose(i);
    pose.translation *= 0.4;
    poses.push_back({Stamp{100'000'000'000 + i * 250'000'000LL}, pose});
  }
  write_tum(place_of("short.tum"), poses);
  const Words wrong{"--poses", place_of("short.tum"), "--overwrite", "-q"};
  const Outcome misfit = expect_ending(ground + wrong, 5);
  EXPECT_NE(misfit.errors.find("short.tum: the poses do not fit the images"), std::string::npos);
  EXPECT_EQ(Json::parse(read_file(fs::path(site) / "manifest.json"))["doubtful"].size(), 1U);

  const Words run{"run", drive,           "--map",   small_drive_map().string(),
                  "-o",  place_of("ran"), "--prior", "truth"};
  expect_ending(run + wrong, 5);
  expect_ending(run + Words{"--seeds", "0"}, 2);
  expect_ending({"run", "no/such", "--map", "x.tif", "-o", place_of("ran2"), "--prior", "1,2,3"},
                3);
}

/// Starts, waits until a stream holds `said`, sends the signal.
Outcome stopped(const Words& arguments, const std::string& said, int signal) {
  NadirProcess process(arguments);
  process.send_when(signal, said);
  return process.wait();
}

TEST(ExitCode, ASignalEndsARunWithItsNumber) {
  // The first line of progress comes after two of the seeds.
  Words loud = localize(place_of("stopped")) +
               Words{"--seeds", "20", "--particles", "3000", "--progress", "lines", "--json"};
  std::erase(loud, "-q");
  for (const int signal : {SIGINT, SIGTERM}) {
    const Outcome outcome = stopped(loud, " % ", signal);
    EXPECT_EQ(outcome.exit_code, 128 + signal) << outcome.errors;
    const Json document = Json::parse(outcome.output, nullptr, false);
    // The seeds that are done, unless writing them out takes longer than a stop may.
    EXPECT_TRUE(document.contains("runs") ||
                document.value(Json::json_pointer("/error/exit_code"), 0) == 128 + signal)
        << outcome.output;
  }
}

TEST(ExitCode, WhatHasNoEndOfItsOwnEndsWellByASignal) {
  const std::string run = place_of("viewed");
  ASSERT_EQ(nadir(localize(run)).exit_code, 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    const Outcome outcome = stopped({"view", run, "--port", "0", "--json"}, "frames", signal);
    EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
    EXPECT_TRUE(Json::parse(outcome.output, nullptr, false).contains("url")) << outcome.output;

    const Outcome served =
        stopped(localize(place_of("served")) + Words{"--serve", "--port", "0", "--json"},
                "finished; still at", signal);
    EXPECT_EQ(served.exit_code, 0) << served.errors;
    EXPECT_TRUE(Json::parse(served.output, nullptr, false).contains("report")) << served.output;
  }
  expect_ending({"view", "no/such/run"}, 3);
  expect_ending({"view"}, 2);
}

TEST(ExitCode, AFullStandardOutputIsAFailureAndNoCrash) {
  for (const char* arguments : {"version --json", "info no/such --json", "--help"}) {
    const std::string command =
        std::string(NADIR_PROGRAM) + " " + arguments + " >/dev/full 2>" + place_of("full_errors");
    const int status = std::system(command.c_str());
    EXPECT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), std::string(arguments).starts_with("info") ? 3 : 1) << arguments;
  }
}

}  // namespace
}  // namespace nadir::testing
