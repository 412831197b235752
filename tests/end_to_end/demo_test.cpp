// SPDX-License-Identifier: Apache-2.0
// The whole pipeline on a simulated campus, from raw sensors to a pose, by `nadir demo --quick`;
// then faults are planted in what it made, and the limits must notice each.

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "nadir/aerial_mapping/mapping.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

// Two maps of 0.10 m a pixel, each good to about one: sqrt(2) 0.10 m.
constexpr double kLargestRmse = 0.15;
// Half a pixel at the rim of an 18 m map turns it by 0.3 degrees; so do the two maps each.
constexpr double kLargestYawRmse = 0.5;

Json json_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "-q"});
  const Outcome outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  return Json::parse(outcome.output, nullptr, false);
}

class Demo : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (can_solve_poses()) document() = json_of({"demo", "--quick", "-o", folder().string()});
  }
  void SetUp() override {
    if (!can_solve_poses()) GTEST_SKIP() << "built without NADIR_WITH_SFM";
  }

  static fs::path folder() { return scratch_folder() / "demo"; }
  static Json& document() {
    static Json document;
    return document;
  }
  /// The site that the demo made, to be damaged.
  static fs::path copy_of_drive(const std::string& name) {
    const fs::path copy = scratch_folder() / name;
    fs::copy(folder() / "drive", copy, fs::copy_options::recursive);
    return copy;
  }
  /// Whether a run on a site keeps both limits.
  static bool keeps_limits(const fs::path& site, const std::string& run) {
    const Outcome outcome =
        nadir({"localize", site.string(), "-o", (scratch_folder() / run).string(), "--prior",
               "truth", "--json", "-q"});
    EXPECT_TRUE(outcome.exit_code == 0 || outcome.exit_code == 5) << outcome.errors;
    const Json judged = Json::parse(outcome.output, nullptr, false)["evaluation"];
    return judged["ape_trans_m"]["rmse"] <= kLargestRmse &&
           judged["yaw_deg"]["rmse"] <= kLargestYawRmse;
  }
};

TEST_F(Demo, FindsTheRobotFromRawSensors) {
  const Json& methods = document()["methods"];
  ASSERT_EQ(methods.size(), 5U);
  EXPECT_LE(methods["default"]["ape_rmse_m"], kLargestRmse);
  EXPECT_LE(methods["default"]["yaw_rmse_deg"], kLargestYawRmse);
  EXPECT_LT(methods["default"]["ape_rmse_m"], methods["ncc+PF"]["ape_rmse_m"]);
  EXPECT_EQ(document()["doubtful"], Json::array()) << "what the other methods are is no doubt";
  EXPECT_EQ(document()["stand_ins"], Json::array());
  for (const char* stage : {"simulate", "map", "ground", "match", "localize", "eval", "report"}) {
    EXPECT_GT(document()["stages"][stage], 0.0) << stage;
  }
  EXPECT_TRUE(fs::exists(document()["report"].get<std::string>()));
  for (const auto& picture : document()["pictures"]) {
    EXPECT_TRUE(fs::exists(picture.get<std::string>())) << picture;
  }
}

TEST_F(Demo, TheUndamagedSiteKeepsTheLimits) {
  EXPECT_TRUE(keeps_limits(folder() / "drive", "undamaged"));
}

TEST_F(Demo, AShiftedMapIsNoticed) {
  const fs::path site = copy_of_drive("shifted");
  const fs::path file = read_sequence(site).map.value();
  Orthomosaic map = read_orthomosaic(file);
  map.geo.west += 0.5;
  write_orthomosaic(file, map);
  EXPECT_FALSE(keeps_limits(site, "run_shifted"));
}

TEST_F(Demo, AFlippedYawIsNoticed) {
  const fs::path site = copy_of_drive("flipped");
  Trajectory truth = read_tum(site / "truth.tum");
  for (auto& stamped : truth) stamped.pose.yaw = -stamped.pose.yaw;
  write_tum(site / "truth.tum", truth);
  EXPECT_FALSE(keeps_limits(site, "run_flipped"));
}

TEST_F(Demo, ADroppedOdometryIsNoticed) {
  const fs::path site = copy_of_drive("dropped");
  Odometry odometry = read_sequence(site).odometry.value();
  const std::size_t half = odometry.size() / 2;
  for (std::size_t i = half; i < odometry.size(); ++i) odometry[i].pose = odometry[half].pose;
  write_tum(site / "odometry.tum", odometry);
  EXPECT_FALSE(keeps_limits(site, "run_dropped"));
  EXPECT_FALSE(
      Json::parse(read_file(scratch_folder() / "run_dropped" / "manifest.json"))["doubtful"]
          .empty())
      << "nadir says so itself";
}

TEST(DemoPlan, SaysTheCommandsBeforehand) {
  const Json plan = json_of({"demo", "-o", "nowhere", "--dry-run"});
  EXPECT_EQ(plan["commands"].size(), can_solve_poses() ? 15U : 14U);
  EXPECT_EQ(plan["commands"][0].get<std::string>().rfind("nadir simulate -o nowhere/site", 0), 0U);
  EXPECT_FALSE(fs::exists("nowhere"));
}

}  // namespace
}  // namespace nadir::testing
