// SPDX-License-Identifier: Apache-2.0
// The main job on the authors' own data, where it is at hand: convert, localize, match, with the
// accuracy that is promised of the defaults.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "support/data.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Twenty seeds belong to benchmarks/aeroground.py; a few already tell a regression.
constexpr int kSeeds = 3;

class AerogroundTest : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto data = test::find_data("aeroground");
    if (!data) GTEST_SKIP() << test::kNoData;
    site_ = scratch_folder() / "aeroground";
    if (!fs::exists(site_)) {
      const Outcome outcome =
          nadir({"convert", "aeroground", data->string(), "-o", site_.string(), "-q"});
      ASSERT_EQ(outcome.exit_code, 0) << outcome.errors;
    }
  }

  static Json json_of(std::vector<std::string> arguments, int exit_code = 0) {
    arguments.insert(arguments.end(), {"--json", "-q"});
    const Outcome outcome = nadir(arguments);
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
    return Json::parse(outcome.output, nullptr, false);
  }

  fs::path site_;
};

TEST_F(AerogroundTest, LocalizesWithTheDefaults) {
  const Json document =
      json_of({"localize", site_.string(), "-o", (scratch_folder() / "run").string(), "--prior",
               "truth", "--frames", "160:224", "--seeds", std::to_string(kSeeds)});
  const Json& summary = document["summary"];
  EXPECT_EQ(summary["lost"], 0);
  EXPECT_LE(summary["ape_rmse_m"]["highest"], 0.26);
  EXPECT_LE(summary["yaw_rmse_deg"]["highest"], 1.0);
  EXPECT_LE(summary["ape_max_m"]["highest"], 2.0);
  for (const Json& run : document["runs"]) EXPECT_EQ(run["evaluation"]["unanswered"], 0);
}

TEST_F(AerogroundTest, FindsSingleFramesInTheWholeMap) {
  for (const int frame : {161, 180, 205, 220}) {
    const Json document =
        json_of({"match", site_.string(), "--frame", std::to_string(frame), "-o",
                 (scratch_folder() / ("match_" + std::to_string(frame))).string()});
    EXPECT_LE(document["matches"][0]["candidates"][0]["error_m"], 0.5) << frame;
  }
}

// The scores of frame 195 form a ridge along the road, which is hardly there at a quarter of the
// resolution: nadir says itself that the place is doubtful.
TEST_F(AerogroundTest, ACoarseSearchFindsTheHighestPointOfARidge) {
  std::vector<double> scores;
  for (const std::string search : {"full", "coarse_to_fine"}) {
    const Json document =
        json_of({"match", site_.string(), "--frame", "195", "--yaw-range-deg", "180", "--set",
                 "map_matching.search=" + search, "-o", (scratch_folder() / search).string()},
                5);
    scores.push_back(document["matches"][0]["candidates"][0]["score"]);
  }
  EXPECT_GE(scores[1], scores[0] - 1e-3);
}

}  // namespace
}  // namespace nadir::testing
