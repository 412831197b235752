// SPDX-License-Identifier: Apache-2.0
// A recorded drive becomes a site that `nadir localize` takes as it is.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"
#include "end_to_end/small_drive.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/data.hpp"

namespace nadir::testing {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

OrderedJson ordered_json_of(std::vector<std::string> arguments) {
  arguments.insert(arguments.end(), {"--json", "--progress", "none", "--overwrite"});
  const Outcome outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  return outcome.exit_code == 0 ? OrderedJson::parse(outcome.output) : OrderedJson{};
}

std::vector<std::string> keys_of(const OrderedJson& document) {
  std::vector<std::string> keys;
  for (const auto& [key, unused] : document.items()) keys.push_back(key);
  return keys;
}

TEST(Ground, SaysExactlyWhatItPromises) {
  const std::string site = (scratch_folder() / "said").string();
  const OrderedJson document =
      ordered_json_of({"ground", small_drive().string(), "-o", site, "--self-check"});
  EXPECT_EQ(keys_of(document),
            (std::vector<std::string>{"frames", "coverage_18m", "coverage_9m", "odd_even_zncc",
                                      "odd_even_shift_px", "height_disagreement_m", "ms_per_frame",
                                      "warnings", "doubtful"}));
  EXPECT_EQ(keys_of(document["height_disagreement_m"]),
            (std::vector<std::string>{"median", "p90"}));
  EXPECT_EQ(document["frames"], kSmallDriveFrames);
  EXPECT_EQ(document["warnings"], OrderedJson::array());
  EXPECT_GT(document["coverage_9m"], document["coverage_18m"]);
  EXPECT_GT(document["odd_even_zncc"], 0.9);
  EXPECT_EQ(document["odd_even_shift_px"], 0.0);
  EXPECT_LT(document["height_disagreement_m"]["median"], 0.02);
  for (const auto& [stage, ms] : document["ms_per_frame"].items()) EXPECT_GE(ms, 0.0) << stage;

  const OrderedJson plain = ordered_json_of({"ground", small_drive().string(), "-o", site});
  EXPECT_EQ(keys_of(plain), (std::vector<std::string>{"frames", "coverage_18m", "coverage_9m",
                                                      "ms_per_frame", "warnings", "doubtful"}));
}

TEST(Ground, WritesASiteThatLocalizes) {
  const fs::path site = scratch_folder() / "mapped";
  ordered_json_of({"ground", small_drive().string(), "-o", site.string(), "--every", "2f", "--size",
                   "12", "--map", small_drive_map().string()});
  const Sequence sequence = read_sequence(site);
  EXPECT_EQ(sequence.local_maps.size(), 1U + kSmallDriveFrames / 2U) << "a map every other frame";
  EXPECT_EQ(sequence.odometry->size(), kSmallDriveFrames);
  EXPECT_EQ(sequence.truth->size(), kSmallDriveFrames);
  EXPECT_TRUE(fs::exists(site / "overview.png"));
  EXPECT_TRUE(fs::exists(site / "frames.csv"));
  const Frame last = read_frame(sequence, sequence.local_maps.back());
  EXPECT_EQ(last.local.width(), 120);
  ASSERT_TRUE(last.elevation);
  EXPECT_NEAR(last.elevation->height_m.at(70, 60), 0.0, 0.03) << "the plane is at the robot's foot";

  const OrderedJson run =
      ordered_json_of({"localize", site.string(), "-o", (scratch_folder() / "run").string(),
                       "--prior", "truth", "--prior-spread", "1,2"});
  EXPECT_LT(run["evaluation"]["ape_trans_m"]["rmse"], 0.15) << run.dump(1);
}

TEST(Run, JoinsMappingAndLocalizing) {
  const fs::path run = scratch_folder() / "joined";
  const OrderedJson document = ordered_json_of(
      {"run", small_drive().string(), "--map", small_drive_map().string(), "-o", run.string(),
       "--every", "2f", "--size", "12", "--prior", "truth", "--prior-spread", "1,2"});
  EXPECT_EQ(document["frames"], 1 + kSmallDriveFrames / 2);
  EXPECT_LT(document["evaluation"]["ape_trans_m"]["rmse"], 0.15) << document.dump(1);
  EXPECT_TRUE(fs::exists(run / "trajectory.tum"));
  EXPECT_TRUE(fs::exists(run / "manifest.json"));
  EXPECT_FALSE(fs::exists(run / "site")) << "nothing in between is written";
  EXPECT_EQ(OrderedJson::parse(read_file(run / "manifest.json"))["sources"]["drive"],
            small_drive().string());
}

/// What is kept is what `nadir ground` writes, and one mapping serves all seeds.
TEST(Run, KeepsItsLocalMapsAndRunsSeveralSeeds) {
  const fs::path site = scratch_folder() / "to_compare";
  const fs::path run = scratch_folder() / "seeds";
  const std::vector<std::string> mapping{"--every", "4f", "--size", "12"};
  std::vector<std::string> ground{"ground", small_drive().string(), "-o", site.string()};
  ground.insert(ground.end(), mapping.begin(), mapping.end());
  ordered_json_of(ground);
  std::vector<std::string> both{"run",
                                small_drive().string(),
                                "-o",
                                run.string(),
                                "--map",
                                small_drive_map().string(),
                                "--prior",
                                "truth",
                                "--prior-spread",
                                "1,2",
                                "--seed",
                                "0",
                                "--seeds",
                                "2",
                                "--keep-maps"};
  both.insert(both.end(), mapping.begin(), mapping.end());
  const OrderedJson document = ordered_json_of(both);
  EXPECT_EQ(document["runs"].size(), 2U);
  EXPECT_TRUE(fs::exists(run / "seed_0" / "trajectory.tum"));
  EXPECT_NE(read_file(run / "seed_0" / "trajectory.tum"),
            read_file(run / "seed_1" / "trajectory.tum"));
  const OrderedJson sources = OrderedJson::parse(read_file(run / "manifest.json"))["sources"];
  EXPECT_EQ(sources["site"], (run / "site").string());
  const Sequence kept = read_sequence(run / "site");
  const Sequence written = read_sequence(site);
  ASSERT_EQ(kept.local_maps.size(), written.local_maps.size());
  for (std::size_t i = 0; i < kept.local_maps.size(); ++i) {
    EXPECT_EQ(read_file(kept.local_maps[i].image), read_file(written.local_maps[i].image));
    EXPECT_EQ(read_file(*kept.local_maps[i].elevation),
              read_file(*written.local_maps[i].elevation));
  }
  EXPECT_EQ(kept.truth->size(), written.truth->size());
}

/// The local map shows the ground where the ground is.
TEST(Ground, PutsTheGroundWhereItIs) {
  const fs::path site = scratch_folder() / "placed";
  ordered_json_of(
      {"ground", small_drive().string(), "-o", site.string(), "--every", "100m", "--size", "8"});
  const Sequence sequence = read_sequence(site);
  const Frame frame = read_frame(sequence, sequence.local_maps.back());
  const Orthomosaic plane = read_orthomosaic(small_drive_map());
  const Pose2 pose = sequence.truth->back().pose;
  double sum = 0.0;
  int count = 0;
  for (int row = 0; row < frame.local.height(); ++row) {
    for (int column = 0; column < frame.local.width(); ++column) {
      if (frame.local.valid.at(column, row) == 0) continue;
      const GeoReference& geo = frame.local.geo;
      const auto p = pose * Point2<frames::Robot>{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      const PixelCoordinate at = plane.geo.pixel_at(p.x, p.y);
      const int u = static_cast<int>(at.column);
      const int v = static_cast<int>(at.row);
      sum += std::abs(frame.local.image.at(column, row) - plane.image.at(u, v));
      ++count;
    }
  }
  ASSERT_GT(count, 1000);
  // Displaced by a metre, two places of this plane differ by 30 grey values on average.
  EXPECT_LT(sum / count, 12.0);
}

TEST(Ground, GivesTheSameBytesForAnyNumberOfThreads) {
  const auto bytes_of = [](const std::string& threads) {
    const fs::path site = scratch_folder() / ("threads_" + threads);
    ordered_json_of({"ground", small_drive().string(), "-o", site.string(), "--every", "4m",
                     "--threads", threads});
    std::string bytes;
    for (const auto& local_map : read_sequence(site).local_maps) {
      bytes += read_file(local_map.image) + read_file(*local_map.elevation);
    }
    return bytes + read_file(site / "odometry.tum") + read_file(site / "frames.csv");
  };
  EXPECT_EQ(bytes_of("1"), bytes_of("2"));
}

TEST(Ground, ExplainsWithoutWriting) {
  const fs::path site = scratch_folder() / "not_written";
  const Outcome outcome =
      nadir({"ground", small_drive().string(), "-o", site.string(), "--dry-run", "--json"});
  EXPECT_EQ(outcome.exit_code, 0) << outcome.errors;
  EXPECT_EQ(OrderedJson::parse(outcome.output)["local_maps"], kSmallDriveFrames);
  EXPECT_FALSE(fs::exists(site));
}

/// What the design asks of the real sequences (docs/ground-mapping.md).
struct RealDrive {
  const char* name;
  double zncc;
  double height_median_m;
};

void expect_no_doubt_of_poses(const Json& document) {
  for (const auto& warning : document["warnings"]) {
    EXPECT_EQ(warning.get<std::string>().find("the poses"), std::string::npos) << warning;
  }
}

class GroundOnKitti : public ::testing::TestWithParam<RealDrive> {};

TEST_P(GroundOnKitti, IsCoveredAndAgreesWithItself) {
  const RealDrive& real = GetParam();
  const auto drive = test::find_data(std::string("kitti_stereo/") + real.name);
  if (!drive) GTEST_SKIP() << test::kNoData;
  const OrderedJson document = ordered_json_of(
      {"ground", drive->string(), "-o", (scratch_folder() / real.name).string(), "--self-check"});
  EXPECT_EQ(document["frames"], 51);
  EXPECT_GE(document["coverage_18m"], 0.96);
  EXPECT_GE(document["odd_even_zncc"], real.zncc);
  EXPECT_EQ(document["odd_even_shift_px"], 0.0);
  EXPECT_LE(document["height_disagreement_m"]["median"], real.height_median_m);
  expect_no_doubt_of_poses(document);
}

TEST(GroundOnKittiPoses, OfAnotherDriveAreRefused) {
  const auto drive = test::find_data("kitti_stereo/odometry_01");
  const auto other = test::find_data("kitti_stereo/straight_street/poses.txt");
  if (!drive || !other) GTEST_SKIP() << test::kNoData;
  const fs::path site = scratch_folder() / "other_poses";
  const Outcome outcome =
      nadir({"ground", drive->string(), "-o", site.string(), "--poses", other->string(), "-q"});
  EXPECT_EQ(outcome.exit_code, 3) << outcome.errors;
  EXPECT_NE(outcome.errors.find("straight_street/poses.txt: the poses do not fit the images"),
            std::string::npos)
      << outcome.errors;
  EXPECT_FALSE(fs::exists(site));
}

TEST(GroundOnKittiPoses, OfARobotThatStandsInTrafficAreNotDoubted) {
  const auto drive = test::find_data("kitti_lidar");
  if (!drive) GTEST_SKIP() << test::kNoData;
  const fs::path standing = scratch_folder() / "standing.txt";
  std::string rows;
  for (int i = 0; i < 15; ++i) rows += "1 0 0 0 0 1 0 0 0 0 1 0\n";
  write_file_as(standing, rows);
  const OrderedJson document =
      ordered_json_of({"ground", drive->string(), "-o", (scratch_folder() / "queue").string(),
                       "--poses", standing.string(), "--pose-frame", "robot"});
  expect_no_doubt_of_poses(document);
}

INSTANTIATE_TEST_SUITE_P(Drives, GroundOnKitti,
                         ::testing::Values(RealDrive{"straight_street", 0.90, 0.015},
                                           RealDrive{"odometry_01", 0.86, 0.03}),
                         [](const auto& drive) { return std::string(drive.param.name); });

}  // namespace
}  // namespace nadir::testing
