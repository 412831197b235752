// SPDX-License-Identifier: Apache-2.0
#include "nadir/core/options.hpp"

#include <gtest/gtest.h>

#include <array>

#include "nadir/core/error.hpp"

namespace nadir {
namespace {

enum class Colour { kRed, kBlue };
constexpr std::array<std::pair<Colour, const char*>, 2> kColours{
    {{Colour::kRed, "red"}, {Colour::kBlue, "blue"}}};

class OptionTableTest : public testing::Test {
 protected:
  OptionTableTest() {
    table_.number("filter.temper", temper_, {0.0, 1000.0}, "Sharpness.");
    table_.integer("filter.particles", particles_, {1.0, 1e6}, "Count.");
    table_.flag("filter.adaptive", adaptive_, "Adapts.");
    table_.choice<Colour>("filter.colour", colour_, kColours, "Colour.");
  }

  std::string message(const std::string& name, const std::string& value) {
    try {
      table_.set(name, value, "run.yaml:3");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kUsage);
      return error.what();
    }
    return "no error";
  }

  double temper_ = 50.0;
  int particles_ = 1000;
  bool adaptive_ = false;
  Colour colour_ = Colour::kRed;
  OptionTable table_;
};

TEST_F(OptionTableTest, SetsEveryType) {
  table_.set("filter.temper", "12.5");
  table_.set("filter.particles", "1e3");
  table_.set("filter.adaptive", "on");
  table_.set("filter.colour", "blue");
  EXPECT_EQ(temper_, 12.5);
  EXPECT_EQ(particles_, 1000);
  EXPECT_TRUE(adaptive_);
  EXPECT_EQ(colour_, Colour::kBlue);
}

TEST_F(OptionTableTest, TextRoundTrips) {
  temper_ = 0.1;
  for (const Option& option : table_.options()) EXPECT_NO_THROW(option.set(option.get()));
  EXPECT_EQ(temper_, 0.1);
  EXPECT_EQ(table_.options().front().default_value, "50");
}

TEST_F(OptionTableTest, UnknownNameNamesTheNearest) {
  EXPECT_EQ(message("filter.tempr", "1"),
            "run.yaml:3: unknown option 'filter.tempr'; did you mean 'filter.temper'?");
  EXPECT_EQ(message("particles", "1"),
            "run.yaml:3: unknown option 'particles'; did you mean 'filter.particles'?");
}

TEST_F(OptionTableTest, BadValuesAreRefusedAndChangeNothing) {
  EXPECT_EQ(message("filter.temper", "-1"),
            "run.yaml:3: option filter.temper is -1, allowed is 0 .. 1000");
  for (const char* value : {"nan", "inf", "", "5x", "0x10"}) {
    EXPECT_NE(message("filter.temper", value), "no error") << value;
  }
  EXPECT_NE(message("filter.particles", "2.5"), "no error");
  EXPECT_NE(message("filter.adaptive", "maybe"), "no error");
  EXPECT_EQ(message("filter.colour", "bleu"),
            "run.yaml:3: option filter.colour is 'bleu', allowed are red, blue (nearest: blue)");
  EXPECT_EQ(temper_, 50.0);
  EXPECT_EQ(particles_, 1000);
}

}  // namespace
}  // namespace nadir
