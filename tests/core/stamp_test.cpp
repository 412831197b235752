// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/stamp.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace nadir {
namespace {

TEST(Stamp, KeepsNanoseconds) {
  const auto stamp = parse_stamp("1403636579.763555527");
  ASSERT_TRUE(stamp);
  EXPECT_EQ(stamp->nanoseconds, 1403636579763555527);
  EXPECT_EQ(to_string(*stamp), "1403636579.763555527");
}

TEST(Stamp, ReadsWhatPeopleWrite) {
  EXPECT_EQ(parse_stamp("12")->nanoseconds, 12'000'000'000);
  EXPECT_EQ(parse_stamp(".5")->nanoseconds, 500'000'000);
  EXPECT_EQ(parse_stamp("-0.25")->nanoseconds, -250'000'000);
  EXPECT_EQ(parse_stamp("3.")->nanoseconds, 3'000'000'000);
  EXPECT_EQ(parse_stamp("1.6e2")->nanoseconds, 160'000'000'000);
  EXPECT_EQ(parse_stamp("0.1234567899")->nanoseconds, 123'456'789);
}

TEST(Stamp, RefusesTheRest) {
  for (const char* text :
       {"", "-", ".", "abc", "1.2.3", "1 2", "--1", "1e", "nan", "99999999999", "4600000001",
        "-4600000001", "4.7e9", "-4.7e9", "9999999999999999999999"}) {
    EXPECT_FALSE(parse_stamp(text)) << text;
  }
}

TEST(Stamp, TextRoundTrips) {
  for (const std::int64_t value :
       {std::int64_t{0}, std::int64_t{-1}, std::int64_t{1}, std::int64_t{-1'500'000'000},
        std::numeric_limits<std::int64_t>::max() / 4}) {
    EXPECT_EQ(parse_stamp(to_string(Stamp{value})), Stamp{value});
  }
}

}  // namespace
}  // namespace nadir
