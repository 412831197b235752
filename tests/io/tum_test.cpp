// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/tum.hpp"

#include <gtest/gtest.h>

#include "nadir/core/random.hpp"
#include "support/expect_error.hpp"
#include "support/temporary_folder.hpp"

namespace nadir {
namespace {

using test::expect_error;
using test::TemporaryFolder;

TEST(Tum, RoundTripsRandomTrajectories) {
  const TemporaryFolder folder;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomStream random(seed, 0);
    Trajectory written;
    std::int64_t nanoseconds = 1'403'636'579'763'555'527;
    for (std::uint64_t i = 0; i < 50; ++i) {
      nanoseconds += 1 + static_cast<std::int64_t>(random.uniform(4 * i, 0.0, 1e10));
      written.push_back(
          {Stamp{nanoseconds},
           {random.uniform(4 * i + 1, -6e5, 6e5), random.uniform(4 * i + 2, -5e6, 5e6),
            random.uniform(4 * i + 3, -kPi, kPi)}});
    }
    write_tum(folder / "a.tum", written);
    const Trajectory read = read_tum(folder / "a.tum");
    ASSERT_EQ(read.size(), written.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      EXPECT_EQ(read[i].stamp, written[i].stamp);
      EXPECT_NEAR(read[i].pose.x, written[i].pose.x, 1e-8);
      EXPECT_NEAR(read[i].pose.y, written[i].pose.y, 1e-8);
      EXPECT_NEAR(wrap_angle(read[i].pose.yaw - written[i].pose.yaw), 0.0, 5e-9);
    }
  }
}

TEST(Tum, KeepsYawAtTheSeam) {
  const TemporaryFolder folder;
  write_tum(
      folder / "a.tum",
      Odometry{{Stamp{0}, {0, 0, kPi}}, {Stamp{1}, {0, 0, -kPi + 1e-12}}, {Stamp{2}, {0, 0, 7.0}}});
  const Odometry read = read_tum_odometry(folder / "a.tum");
  EXPECT_NEAR(read[0].pose.yaw, kPi, 1e-9);
  EXPECT_NEAR(std::abs(read[1].pose.yaw), kPi, 1e-9);
  EXPECT_NEAR(read[2].pose.yaw, wrap_angle(7.0), 5e-9);
}

TEST(Tum, WritesPlainText) {
  const TemporaryFolder folder;
  write_tum(folder / "a.tum", Trajectory{{Stamp{1'500'000'000}, {-1e-12, 2.5, -0.0}}});
  EXPECT_EQ(test::read_text(folder / "a.tum"),
            "# timestamp tx ty tz qx qy qz qw\n"
            "1.500000000 0.000000000 2.500000000 0 0 0 0.000000000 1.000000000\n");
}

TEST(Tum, ReadsCommentsCarriageReturnsTabsAndBlankLines) {
  const TemporaryFolder folder;
  test::write_text(folder / "a.tum",
                   "# a comment\r\n\r\n0 1 2 3 0 0 0 1\r\n\t0.5\t4 5 6 0 0 2 2 # turned left");
  const Trajectory read = read_tum(folder / "a.tum");
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].pose.x, 1.0);
  EXPECT_EQ(read[1].stamp.nanoseconds, 500'000'000);
  EXPECT_NEAR(read[1].pose.yaw, kPi / 2.0, 1e-12);
}

TEST(Tum, AnUnansweredRunIsAnEmptyTrajectory) {
  const TemporaryFolder folder;
  write_tum(folder / "a.tum", Trajectory{});
  EXPECT_TRUE(read_tum(folder / "a.tum").empty());
}

TEST(Tum, TakesTheHeadingOfATiltedRobot) {
  const TemporaryFolder folder;
  // Yaw 90 degrees after pitch 20 degrees: q = q_z(90) * q_y(20).
  const double cy = std::cos(kPi / 4);
  const double sp = std::sin(radians(10.0));
  const double cp = std::cos(radians(10.0));
  std::string line = "0 0 0 0";
  for (const double value : {-cy * sp, cy * sp, cy * cp, cy * cp}) {
    line += " " + std::to_string(value);
  }
  test::write_text(folder / "a.tum", line);
  EXPECT_NEAR(read_tum(folder / "a.tum")[0].pose.yaw, kPi / 2.0, 1e-5);
}

TEST(Tum, RefusesBadLines) {
  const TemporaryFolder folder;
  const auto refuse = [&folder](const std::string& text, std::initializer_list<std::string> parts) {
    test::write_text(folder / "a.tum", "0 0 0 0 0 0 0 1\n" + text);
    expect_error(ErrorKind::kInput, parts, [&folder] { read_tum(folder / "a.tum"); });
  };
  refuse("1 0 0 0 0 0 1", {"a.tum:2", "7 values instead of 8"});
  refuse("1 0 0 0 0 0 0 0 1", {"a.tum:2", "9 values instead of 8"});
  refuse("1,0,0,0,0,0,0,1", {"a.tum:2", "1 values instead of 8", "separated by spaces"});
  refuse("# fine\none 0 0 0 0 0 0 1", {"a.tum:3", "timestamp", "'one'"});
  refuse("1 nan 0 0 0 0 0 1", {"a.tum:2", "tx", "'nan'", "finite"});
  refuse("1 0 inf 0 0 0 0 1", {"a.tum:2", "ty"});
  refuse("1 0 0 0 0 0 0 0", {"a.tum:2", "quaternion is zero"});
  refuse("1 0 0 0 0.5 0.5 0.5 -0.5", {"a.tum:2", "straight up or down"});
  refuse("0 0 0 0 0 0 0 1", {"a.tum:2", "does not follow 0.000000000"});
  refuse("-1 0 0 0 0 0 0 1", {"a.tum:2", "does not follow"});
}

TEST(Tum, RefusesMissingAndEmptyFiles) {
  const TemporaryFolder folder;
  expect_error(ErrorKind::kInput, {"a.tum", "no such file"}, [&] { read_tum(folder / "a.tum"); });
  test::write_text(folder / "a.tum", "");
  expect_error(ErrorKind::kInput, {"is empty"}, [&] { read_tum_odometry(folder / "a.tum"); });
}

TEST(Tum, WritesNothingThatCouldNotBeReadBack) {
  const TemporaryFolder folder;
  const double nan = std::nan("");
  expect_error(ErrorKind::kProcessing, {"a.tum", "3.000000000 s", "not finite"}, [&] {
    write_tum(folder / "a.tum", Trajectory{{Stamp{3'000'000'000}, {nan, 0, 0}}});
  });
  expect_error(ErrorKind::kProcessing, {"not later"}, [&] {
    write_tum(folder / "a.tum", Trajectory{{Stamp{3}, {}}, {Stamp{3}, {}}});
  });
  EXPECT_EQ(test::count_entries(folder.path()), 0);
}

}  // namespace
}  // namespace nadir
