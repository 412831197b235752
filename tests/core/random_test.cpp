// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace nadir {
namespace {

TEST(Philox, AgreesWithTheAuthorsKnownAnswers) {
  // Random123, kat_vectors: philox4x32 10.
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, MomentsAreThoseOfTheDistributions) {
  const RandomStream random(1, 2);
  constexpr int kDraws = 20000;
  double uniform_sum = 0.0;
  double normal_sum = 0.0;
  double normal_squares = 0.0;
  double cross = 0.0;
  for (std::uint64_t i = 0; i < kDraws; ++i) {
    const double u = random.uniform(i);
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    uniform_sum += u;
    const auto [a, b] = random.normal_pair(kDraws + i);
    normal_sum += a + b;
    normal_squares += a * a + b * b;
    cross += a * b;
  }
  EXPECT_NEAR(uniform_sum / kDraws, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
  EXPECT_NEAR(normal_sum / (2 * kDraws), 0.0, 5 / std::sqrt(2.0 * kDraws));
  EXPECT_NEAR(normal_squares / (2 * kDraws), 1.0, 5 / std::sqrt(1.0 * kDraws));
  EXPECT_NEAR(cross / kDraws, 0.0, 5 / std::sqrt(1.0 * kDraws));
}

TEST(RandomStream, DifferBySeedAndStream) {
  EXPECT_NE(RandomStream(1, 0).uniform(0), RandomStream(2, 0).uniform(0));
  EXPECT_NE(RandomStream(1, 0).uniform(0), RandomStream(1, 1).uniform(0));
  EXPECT_EQ(RandomStream(1, 1).uniform(9), RandomStream(1, 1).uniform(9));
}

}  // namespace
}  // namespace nadir
