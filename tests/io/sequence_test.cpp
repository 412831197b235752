// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/sequence.hpp"

#include <gtest/gtest.h>

#include "io/random_raster.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::random_orthomosaic;
using test::TemporaryFolder;

constexpr std::int64_t kSecond = 1'000'000'000;

Orthomosaic local_map(std::uint64_t seed) {
  Orthomosaic local = random_orthomosaic(18, 12, 1, seed);
  local.geo = {-0.9, 0.6, 0.1, {}};
  return local;
}

/// A site with three local maps at 1, 2 and 3.5 s.
void write_site(const std::filesystem::path& folder) {
  SequenceWriter writer(folder, "a \"quoted\" name: with # signs");
  writer.write_map(random_orthomosaic(50, 40, 3, 1));
  writer.write_local_map(4, Stamp{1 * kSecond}, local_map(2));
  writer.write_local_map(7, Stamp{2 * kSecond}, local_map(3));
  writer.write_local_map(8, Stamp{3 * kSecond + 500'000'001}, local_map(4));
  writer.write_odometry({{Stamp{1 * kSecond + 5'000'000}, {1, 2, 0.5}},
                         {Stamp{1 * kSecond + 900'000'000}, {2, 0, 3.0}},
                         {Stamp{2 * kSecond + 100'000'000}, {4, 1, -3.0}}});
  writer.write_truth({{Stamp{1 * kSecond}, {10, 20, 0.5}}});
  writer.finish();
}

TEST(Sequence, RoundTrips) {
  const TemporaryFolder folder;
  write_site(folder / "site");
  const Sequence site = read_sequence(folder / "site");
  EXPECT_EQ(site.name, "a \"quoted\" name: with # signs");
  EXPECT_EQ(read_orthomosaic(*site.map).image, random_orthomosaic(50, 40, 3, 1).image);
  ASSERT_EQ(site.local_maps.size(), 3U);
  EXPECT_EQ(site.local_maps[1].number, 7);
  EXPECT_EQ(site.local_maps[2].stamp.nanoseconds, 3'500'000'001);
  EXPECT_EQ(site.odometry->size(), 3U);
  EXPECT_NEAR(site.truth->at(0).pose.y, 20.0, 1e-9);
  EXPECT_FALSE(site.calibration);

  const Frame frame = read_frame(site, site.local_maps[1]);
  EXPECT_EQ(frame.stamp, site.local_maps[1].stamp);
  EXPECT_EQ(frame.local.image, local_map(3).image);
  EXPECT_EQ(frame.local.valid, local_map(3).valid);
  EXPECT_NEAR(frame.local.geo.west, -0.9, 1e-12);
  EXPECT_NEAR(frame.local.geo.north, 0.6, 1e-12);
}

TEST(Sequence, FindsTheOdometryOfAFrame) {
  const TemporaryFolder folder;
  write_site(folder / "site");
  const Sequence site = read_sequence(folder / "site");
  const Frame nearest = read_frame(site, site.local_maps[0]);  // 5 ms away
  ASSERT_TRUE(nearest.odom_from_robot);
  EXPECT_NEAR(nearest.odom_from_robot->x, 1.0, 1e-9);

  const Frame between = read_frame(site, site.local_maps[1]);  // in the middle, over the seam
  ASSERT_TRUE(between.odom_from_robot);
  EXPECT_NEAR(between.odom_from_robot->x, 3.0, 1e-8);
  EXPECT_NEAR(between.odom_from_robot->y, 0.5, 1e-8);
  EXPECT_NEAR(std::abs(between.odom_from_robot->yaw), kPi, 1e-8);

  EXPECT_FALSE(read_frame(site, site.local_maps[2]).odom_from_robot);  // none near
}

TEST(Sequence, MayConsistOfLocalMapsAlone) {
  const TemporaryFolder folder;
  SequenceWriter writer(folder / "site", "bare");
  writer.write_local_map(0, Stamp{0}, local_map(1));
  writer.finish();
  const Sequence site = read_sequence(folder / "site");
  EXPECT_FALSE(site.map || site.odometry || site.truth);
  EXPECT_FALSE(read_frame(site, site.local_maps[0]).odom_from_robot);
}

TEST(Sequence, HandsTheCalibrationOn) {
  const TemporaryFolder folder;
  test::write_text(folder / "camera.yaml", "focal_px: 700\n");
  SequenceWriter writer(folder / "site", "calibrated");
  writer.write_calibration(folder / "camera.yaml");
  writer.write_local_map(0, Stamp{0}, local_map(1));
  writer.finish();
  const Sequence site = read_sequence(folder / "site");
  EXPECT_EQ(test::read_text(*site.calibration), "focal_px: 700\n");
}

TEST(Sequence, IsUnfinishedUntilItIsFinished) {
  const TemporaryFolder folder;
  write_site(folder / "site");
  SequenceWriter writer(folder / "site", "again");
  writer.write_local_map(0, Stamp{0}, local_map(1));
  expect_error(ErrorKind::kInput, {"site", "no sequence.yaml", "did not finish"},
               [&] { read_sequence(folder / "site"); });
}

TEST(Sequence, WriterRefusesWhatCouldNotBeReadBack) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kUsage, {"needs a name"}, [&] { SequenceWriter(folder / "site", ""); });
  SequenceWriter writer(folder / "site", "name");
  expect_error(ErrorKind::kProcessing, {"needs a local map"}, [&] { writer.finish(); });
  writer.write_local_map(1, Stamp{1}, local_map(1));
  expect_error(ErrorKind::kProcessing, {"local map 1", "does not follow"},
               [&] { writer.write_local_map(1, Stamp{2}, local_map(1)); });
  expect_error(ErrorKind::kProcessing, {"local map 2", "does not follow"},
               [&] { writer.write_local_map(2, Stamp{1}, local_map(1)); });
  test::write_text(folder / "file", "x");
  expect_error(ErrorKind::kProcessing, {"cannot be written"},
               [&] { SequenceWriter(folder.path() / "file" / "site", "name"); });
}

/// A folder with two local maps, and the sequence.yaml that a test writes.
class BadSequence : public ::testing::Test {
 protected:
  BadSequence() {
    for (const char* name : {"a.png", "b.png"}) write_orthomosaic(folder_ / name, local_map(1));
  }

  void refuse(const std::string& yaml, std::initializer_list<std::string> parts) {
    test::write_text(folder_ / "sequence.yaml", yaml);
    expect_error(ErrorKind::kInput, parts, [this] { read_sequence(folder_.path()); });
  }

  const std::string head_ = "version: 1\nname: bad\n";
  const std::string maps_ =
      "local_maps:\n"
      "  - {number: 1, stamp: 1.0, image: a.png}\n";
  TemporaryFolder folder_;
};

TEST_F(BadSequence, ReadsAStampByItsTextNotAsANumber) {
  test::write_text(folder_ / "sequence.yaml",
                   head_ +
                       "local_maps:\n"
                       "  - {number: 1, stamp: 1403636579.763555527, image: a.png}\n"
                       "  - {number: 2, stamp: \"1403636579.763555528\", image: ./b.png}\n");
  const Sequence site = read_sequence(folder_.path());
  EXPECT_EQ(site.local_maps[0].stamp.nanoseconds, 1403636579763555527);
  EXPECT_EQ(site.local_maps[1].stamp.nanoseconds, 1403636579763555528);
}

TEST_F(BadSequence, NamesTheLineOfABadKey) {
  refuse(head_ + "odometri: a.tum\n" + maps_,
         {"sequence.yaml:3", "unknown key 'odometri'", "did you mean 'odometry'?"});
  refuse(head_ + "local_maps:\n  - {number: 1, stemp: 1, image: a.png}\n",
         {"sequence.yaml:4", "'stemp'", "'stamp'"});
  refuse(head_ + "name: twice\n" + maps_, {"sequence.yaml:3", "'name' is given twice"});
  refuse(head_ + "map: [a, b]\n" + maps_, {"sequence.yaml:3", "'map' must be one text"});
  refuse(head_ + "map:\n" + maps_, {"sequence.yaml:3", "'map' must be one text"});
  refuse("version: 1\n" + maps_, {"has no 'name'"});
}

TEST_F(BadSequence, NamesTheLineOfABadFile) {
  refuse(head_ + "map: none.tif\n" + maps_, {"sequence.yaml:3", "'none.tif' names no file"});
  refuse(head_ + "map: ../a.png\n" + maps_, {"sequence.yaml:3", "leads out of the folder"});
  refuse(head_ + "map: local/../../a.png\n" + maps_, {"leads out of the folder"});
  refuse(head_ + "map: /etc/passwd\n" + maps_, {"leads out of the folder"});
  refuse(head_ + "map: .\n" + maps_, {"names no file"});
  test::write_text(folder_ / "bad.tum", "0 1 2\n");
  refuse(head_ + "truth: bad.tum\n" + maps_, {"bad.tum:1", "3 values instead of 8"});
}

TEST_F(BadSequence, NamesTheLineOfABadLocalMap) {
  refuse(head_ + maps_ + "  - {number: 1, stamp: 2, image: b.png}\n",
         {"sequence.yaml:5", "number 1 after 1"});
  refuse(head_ + maps_ + "  - {number: 2, stamp: 1.0, image: b.png}\n",
         {"sequence.yaml:5", "stamp 1.000000000 after 1.000000000"});
  refuse(head_ + maps_ + "  - {number: 2, stamp: soon, image: b.png}\n",
         {"sequence.yaml:5", "'soon'", "seconds"});
  refuse(head_ + maps_ + "  - {number: two, stamp: 2, image: b.png}\n",
         {"sequence.yaml:5", "'two'", "whole number"});
  refuse(head_ + maps_ + "  - {number: 2, stamp: 2}\n", {"sequence.yaml:5", "no 'image'"});
  refuse(head_ + maps_ + "  - b.png\n", {"sequence.yaml:5", "`key: value`"});
}

TEST_F(BadSequence, RefusesWhatIsNoSequence) {
  refuse(head_, {"sequence.yaml", "lists no local map"});
  refuse(head_ + "local_maps: []\n", {"lists no local map"});
  refuse("version: 2\nname: new\n" + maps_, {"sequence.yaml:1", "version 2", "reads version 1"});
  refuse("name: [\n", {"sequence.yaml:", "is not YAML"});
  refuse("just text\n", {"sequence.yaml:1", "`key: value`"});
  refuse("", {"sequence.yaml", "is empty"});
  expect_error(ErrorKind::kInput, {"none", "no such folder"},
               [&] { read_sequence(folder_ / "none"); });
}

TEST_F(BadSequence, NamesALocalMapWithoutWorldFile) {
  test::write_text(folder_ / "sequence.yaml", head_ + maps_);
  std::filesystem::remove(folder_ / "a.pgw");
  const Sequence site = read_sequence(folder_.path());
  expect_error(ErrorKind::kInput, {"a.png", "no geo-reference", "world file"},
               [&] { read_frame(site, site.local_maps[0]); });
}

}  // namespace
}  // namespace nadir
