// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/drives/aeroground.hpp"

#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "nadir/core/angle.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/aeroground_map.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "support/data.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

constexpr double kMapResolution = 0.1 / 3.54;

/// A made-up run: a map of 40 x 60 pixels, grey 100, with a black border at the left; local maps
/// 3, 4, 5 of 16 x 12 pixels whose upper half is a hole; truth for the first two.
class MadeUpRun : public ::testing::Test {
 protected:
  MadeUpRun() {
    std::filesystem::create_directories(folder_ / "local");
    cv::Mat map(60, 40, CV_8UC3, cv::Scalar::all(100));
    map.colRange(0, 8).setTo(0);
    cv::imwrite(folder_ / "global_no_cars.jpg", map);
    cv::Mat local(12, 16, CV_8UC3, cv::Scalar::all(90));
    local.rowRange(0, 6).setTo(255);
    for (int frame = 3; frame <= 5; ++frame) {
      cv::imwrite(folder_ / ("local/" + std::to_string(frame) + ".jpg"), local);
    }
    write_truth("4 20.5 30 -90 3.5\r\n# a comment\n3 10 15 94.2 3.5\n");
  }

  void write_truth(const std::string& text) { test::write_text(folder_ / "truth.txt", text); }
  void convert() { convert_aeroground(folder_.path(), site(), {}, {}); }
  std::filesystem::path site() const { return folder_ / "site"; }
  void expect_refused(std::initializer_list<std::string> parts) {
    expect_error(ErrorKind::kInput, parts, [this] { convert(); });
    EXPECT_FALSE(std::filesystem::exists(site() / "sequence.yaml"));
  }

  TemporaryFolder folder_;
};

TEST_F(MadeUpRun, BecomesASite) {
  int calls = 0;
  convert_aeroground(folder_.path(), site(), {}, [&calls](int done, int total) {
    EXPECT_EQ(done, ++calls);
    EXPECT_EQ(total, 3);
  });
  EXPECT_EQ(calls, 3);

  const Sequence sequence = read_sequence(site());
  ASSERT_EQ(sequence.local_maps.size(), 3U);
  EXPECT_EQ(sequence.local_maps[0].number, 3);
  EXPECT_EQ(sequence.local_maps[2].stamp.nanoseconds, 5'000'000'000);
  EXPECT_FALSE(sequence.odometry);
  ASSERT_TRUE(sequence.truth);
  ASSERT_EQ(sequence.truth->size(), 2U);
  const auto& first = sequence.truth->at(0);
  EXPECT_EQ(first.stamp.nanoseconds, 3'000'000'000);
  EXPECT_NEAR(first.pose.x, 10 * kMapResolution, 1e-9);
  EXPECT_NEAR(first.pose.y, (60 - 15) * kMapResolution, 1e-9);
  EXPECT_NEAR(first.pose.yaw, radians(-94.2), 1e-8);
  EXPECT_NEAR(sequence.truth->at(1).pose.yaw, kPi / 2.0, 1e-8);
}

TEST_F(MadeUpRun, KeepsImagesAndPlacesThem) {
  convert();
  const Sequence sequence = read_sequence(site());
  const Orthomosaic map = read_orthomosaic(*sequence.map);
  EXPECT_EQ(map.image.channels(), 1);
  EXPECT_EQ(map.geo, (GeoReference{0.0, 60 * kMapResolution, kMapResolution, {}}));
  EXPECT_EQ(map.valid.at(0, 30), 0);
  EXPECT_EQ(map.valid.at(20, 30), 255);
  EXPECT_NEAR(map.image.at(20, 30), 100, 2);

  const Frame frame = read_frame(sequence, sequence.local_maps[1]);
  EXPECT_EQ(frame.stamp.nanoseconds, 4'000'000'000);
  EXPECT_EQ(frame.local.image.channels(), 1);
  EXPECT_NEAR(frame.local.geo.west, -0.8, 1e-12);
  EXPECT_NEAR(frame.local.geo.north, 0.6, 1e-12);
  EXPECT_EQ(frame.local.valid.at(8, 0), 0);
  EXPECT_EQ(frame.local.valid.at(8, 11), 255);
  EXPECT_FALSE(frame.odom_from_robot);
}

TEST_F(MadeUpRun, NeedsNoTruth) {
  std::filesystem::remove(folder_ / "truth.txt");
  convert();
  EXPECT_FALSE(read_sequence(site()).truth);
}

TEST_F(MadeUpRun, TakesTruthFromElsewhere) {
  test::write_text(folder_ / "other.txt", "5 1 2 3 3.54\n");
  convert_aeroground(folder_.path(), site(), {folder_ / "other.txt", "global_no_cars.jpg"}, {});
  EXPECT_EQ(read_sequence(site()).truth->size(), 1U);
}

TEST_F(MadeUpRun, RefusesAMissingFrame) {
  std::filesystem::remove(folder_ / "local/4.jpg");
  expect_refused({"4.jpg", "is missing, though 5.jpg is there"});
}

TEST_F(MadeUpRun, RefusesAMissingMap) {
  std::filesystem::remove(folder_ / "global_no_cars.jpg");
  expect_refused({"global_no_cars.jpg", "no such file"});
}

TEST_F(MadeUpRun, RefusesADamagedLocalMapBeforeTheSiteIsFinished) {
  std::filesystem::resize_file(folder_ / "local/5.jpg", 200);
  expect_refused({"5.jpg", "cut off"});
}

TEST_F(MadeUpRun, RefusesBadTruth) {
  write_truth("3 1 2 3 3.5\n4 1 2 3\n");
  expect_refused({"truth.txt:2", "4 values instead of 5"});
  write_truth("3 1 2 x 3.5\n");
  expect_refused({"truth.txt:1", "rotation", "'x'"});
  write_truth("3 1 2 nan 3.5\n");
  expect_refused({"truth.txt:1", "rotation", "finite"});
  write_truth("3.5 1 2 3 3.5\n");
  expect_refused({"truth.txt:1", "frame", "whole number"});
  write_truth("3 1 2 3 0\n");
  expect_refused({"truth.txt:1", "scale"});
  write_truth("3 1 2 3 3.5\n4 1 2 3 3.5\n3 1 2 3 3.5\n");
  expect_refused({"truth.txt:3", "frame 3 is given twice", "truth.txt:1"});
  write_truth("6 1 2 3 3.5\n");
  expect_refused({"truth.txt:1", "frame 6 has no local map"});
}

TEST(SeenByDrone, KeepsSmallDarkSpotsInside) {
  Raster<std::uint8_t> image(100, 80, 120);
  for (int row = 0; row < 80; ++row) image.at(99, row) = 3;  // JPEG ringing at the border
  for (int i = 0; i < 10; ++i) image.at(20 + i, 20) = 0;     // a dark spot
  for (int i = 0; i < 900; ++i) image.at(40 + i % 30, 40 + i / 30) = 0;  // a hole
  const Raster<std::uint8_t> seen = seen_by_drone(image);
  EXPECT_EQ(seen.at(99, 40), 0);
  EXPECT_EQ(seen.at(97, 40), 0);  // mixed with black
  EXPECT_EQ(seen.at(96, 40), 255);
  EXPECT_EQ(seen.at(25, 20), 255);
  EXPECT_EQ(seen.at(50, 50), 0);
}

TEST(RealRun, BecomesASite) {
  const auto data = test::find_data("aeroground");
  if (!data) GTEST_SKIP() << test::kNoData;
  const TemporaryFolder folder;
  convert_aeroground(*data, folder / "site", {}, {});

  const Sequence sequence = read_sequence(folder / "site");
  ASSERT_EQ(sequence.local_maps.size(), 362U);
  EXPECT_EQ(sequence.local_maps.back().number, 361);
  EXPECT_EQ(sequence.truth->size(), 56U);

  const Orthomosaic map = read_orthomosaic(*sequence.map);
  EXPECT_EQ(map.image.channels(), 1);
  EXPECT_EQ(map.width(), 1471);
  EXPECT_EQ(map.height(), 4096);
  for (const auto& [stamp, pose] : *sequence.truth) {
    const PixelCoordinate at = map.geo.pixel_at(pose.x, pose.y);
    EXPECT_NE(map.valid.at(static_cast<int>(at.column), static_cast<int>(at.row)), 0)
        << to_string(stamp);
  }
  const Frame small = read_frame(sequence, sequence.local_maps[356]);
  EXPECT_EQ(small.local.width(), 160);
  EXPECT_NEAR(small.local.geo.west, -8.0, 1e-9);
}

}  // namespace
}  // namespace nadir
