// SPDX-License-Identifier: Apache-2.0
// What the program says of itself, and to what it does not understand.

#include <gtest/gtest.h>

#include <algorithm>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_site.hpp"
#include "nadir/map_matching/cuda_status.hpp"

namespace nadir::testing {
namespace {

const std::vector<std::vector<std::string>> kVerbs{{"simulate"},
                                                   {"map"},
                                                   {"convert", "aeroground"},
                                                   {"ground"},
                                                   {"run"},
                                                   {"info"},
                                                   {"match"},
                                                   {"localize"},
                                                   {"eval"},
                                                   {"demo"},
                                                   {"doctor"},
                                                   {"view"},
                                                   {"report"},
                                                   {"config", "dump"},
                                                   {"completion"},
                                                   {"version"}};

/// One line on standard error that begins "nadir: error: ", nothing on standard output.
void expect_refused(const Outcome& outcome, int exit_code, const std::string& part) {
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
  EXPECT_TRUE(outcome.errors.starts_with("nadir: error: ")) << outcome.errors;
  EXPECT_EQ(std::ranges::count(outcome.errors, '\n'), 1) << outcome.errors;
  EXPECT_NE(outcome.errors.find(part), std::string::npos) << outcome.errors;
  EXPECT_EQ(outcome.output, "");
}

TEST(UsageTest, PlainProgramPrintsVerbsAndAnExample) {
  const Outcome outcome = nadir({});
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_NE(outcome.output.find("Example"), std::string::npos);
  for (const auto& verb : kVerbs) EXPECT_NE(outcome.output.find(verb.front()), std::string::npos);
}

TEST(UsageTest, EveryVerbHasHelpWithExamples) {
  for (std::vector<std::string> verb : kVerbs) {
    verb.emplace_back("--help");
    const Outcome outcome = nadir(verb);
    EXPECT_EQ(outcome.exit_code, 0) << verb.front();
    EXPECT_NE(outcome.output.find("Example"), std::string::npos) << verb.front();
  }
}

TEST(UsageTest, UnknownVerbsAndOptionsNameTheNearest) {
  expect_refused(nadir({"lokalize", "site", "-o", "run"}), 2, "did you mean 'localize'?");
  expect_refused(nadir({"config", "dmp"}), 2, "did you mean 'dump'?");
  expect_refused(nadir({"localize", "site", "--scor", "ncc"}), 2, "did you mean '--score'?");
  expect_refused(nadir({"--versoin"}), 2, "did you mean '--version'?");
  expect_refused(nadir({"config", "dump", "--set", "localization.tempr=3"}), 2,
                 "did you mean 'localization.temper'?");
  expect_refused(nadir({"config", "dump"}, {"NADIR_LOCALIZATION_TEMPR=3"}), 2,
                 "did you mean 'NADIR_LOCALIZATION_TEMPER'?");
}

TEST(UsageTest, BadValuesAreUsageErrors) {
  const std::string site = small_site().string();
  const std::string run = (scratch_folder() / "refused").string();
  expect_refused(nadir({"localize", site, "-o", run}), 2, "--prior");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "1,2"}), 2, "--prior");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "1,2,nan"}), 2, "--prior");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "truth", "--frames", "5:2"}), 2,
                 "--frames");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "truth", "--frames", "900:"}), 2,
                 "frames 0 to 7");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "truth", "--score", "nc"}), 2,
                 "nearest: ncc");
  expect_refused(nadir({"localize", site, "-o", run, "--prior", "truth", "--particles", "0"}), 2,
                 "localization.particles");
  if (!cuda_status().usable) {
    expect_refused(nadir({"localize", site, "-o", run, "--prior", "truth", "--device", "cuda"}), 2,
                   "cuda");
  }
  expect_refused(nadir({"localize", site, "--prior", "truth"}), 2, "--output");
  expect_refused(nadir({"match", site, "-o", run, "--frame", "77"}), 2, "frames 0 to 7");
  EXPECT_FALSE(std::filesystem::exists(run));
}

TEST(UsageTest, AGivenMapLeavesNothingToTheOptionsOfProceduralWorlds) {
  const std::string map = (small_site() / "map.tif").string();
  const std::string site = (scratch_folder() / "draped").string();
  const auto simulate = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"simulate", "-o", site, "--from", map, "--dry-run"};
    words.insert(words.end(), more.begin(), more.end());
    return nadir(words);
  };
  EXPECT_EQ(simulate({}).exit_code, 0);
  expect_refused(simulate({"--preset", "farm"}), 2, "--preset: simulation.preset");
  expect_refused(simulate({"--set", "simulation.width_m=50"}), 2, "simulation.width_m");
  expect_refused(simulate({"--set", "simulation.drive_lane_offset_m=1"}), 2, "drive_lane_offset_m");
}

TEST(UsageTest, PrecedenceIsFlagSetEnvironmentFileDefault) {
  const auto config = scratch_folder() / "run.yaml";
  write_file_as(config, "localization:\n  temper: 11\n  particles: 12\n  resample_below: 0.4\n");
  const std::vector<std::string> environment{"NADIR_LOCALIZATION_TEMPER=21",
                                             "NADIR_LOCALIZATION_PARTICLES=22"};
  const Outcome outcome =
      nadir({"config", "dump", "--config", config.string(), "--set", "localization.temper=31"},
            environment);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_NE(outcome.output.find("temper: 31\n"), std::string::npos);
  EXPECT_NE(outcome.output.find("particles: 22\n"), std::string::npos);
  EXPECT_NE(outcome.output.find("resample_below: 0.4\n"), std::string::npos);
  for (const char* origin : {"--set", "NADIR_LOCALIZATION_PARTICLES", "run.yaml:4"}) {
    EXPECT_NE(outcome.output.find(origin), std::string::npos) << origin;
  }
}

TEST(UsageTest, DumpedOptionsReadBack) {
  const Outcome first = nadir({"config", "dump", "--preset", "paper"});
  const auto config = scratch_folder() / "dumped.yaml";
  write_file_as(config, first.output);
  const auto values = [](const std::string& text) {
    std::string kept;
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = text.find('\n', begin);
      const std::string line = text.substr(begin, end - begin);
      if (line.find('#') == std::string::npos) kept += line + "\n";
      begin = end + 1;
    }
    return kept;
  };
  const Outcome second = nadir({"config", "dump", "--config", config.string()});
  EXPECT_EQ(second.exit_code, 0) << second.errors;
  EXPECT_EQ(values(second.output), values(first.output));
}

TEST(UsageTest, BadConfigFilesNameFileAndLine) {
  const auto config = scratch_folder() / "bad.yaml";
  write_file_as(config, "localization:\n  tempr: 1\n");
  expect_refused(nadir({"config", "dump", "--config", config.string()}), 2, "bad.yaml:2");
  expect_refused(nadir({"config", "dump", "--config", "no/such.yaml"}), 3, "no/such.yaml");
}

TEST(UsageTest, CompletionScriptsMentionEveryVerb) {
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Outcome outcome = nadir({"completion", shell});
    EXPECT_EQ(outcome.exit_code, 0);
    for (const auto& verb : kVerbs) {
      for (const std::string& word : verb) {
        EXPECT_NE(outcome.output.find(word), std::string::npos) << shell << " " << word;
      }
    }
    EXPECT_NE(outcome.output.find("prior-spread"), std::string::npos) << shell;
  }
  expect_refused(nadir({"completion", "tcsh"}), 2, "shell");
}

TEST(UsageTest, ClosedPipeEndsQuietly) {
  const auto errors = scratch_folder() / "pipe_errors";
  const std::string command = std::string("bash -c 'set -o pipefail; ") + NADIR_PROGRAM +
                              " config dump 2>" + errors.string() + " | true'";
  EXPECT_EQ(std::system(command.c_str()), 0);
  EXPECT_EQ(read_file(errors), "");
}

}  // namespace
}  // namespace nadir::testing
