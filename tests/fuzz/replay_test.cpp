// SPDX-License-Identifier: Apache-2.0
// Gives every file of tests/fuzz/corpus/<target> to its target: seeds, and whatever crashed once.
#include <gtest/gtest.h>

#include <set>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/input_file.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::fuzz {

static void PrintTo(const Target& target, std::ostream* out) { *out << target.name; }

namespace {

const std::filesystem::path kCorpus = "tests/fuzz/corpus";

class Replay : public testing::TestWithParam<Target> {};

TEST_P(Replay, TakesEveryFileOfTheCorpus) {
  const std::vector<std::filesystem::path> files =
      files_in(kCorpus / GetParam().name, Depth::kFolder);
  ASSERT_FALSE(files.empty()) << "no corpus: see tests/fuzz/README.md";
  int accepted = 0;
  for (const std::filesystem::path& file : files) {
    const std::string input = test::read_text(file);
    EXPECT_NO_THROW(accepted += run_target(GetParam().body, input) ? 1 : 0) << file;
  }
  EXPECT_GT(accepted, 0) << "no seed is sound: the target cannot get behind the first check";
}

TEST(ReplayItself, TakesOnlyOurErrorsForAnswers) {
  EXPECT_TRUE(run_target([](std::string_view) {}, ""));
  EXPECT_FALSE(run_target([](std::string_view) { throw Error(ErrorKind::kInput, "bad"); }, ""));
  EXPECT_THROW(run_target([](std::string_view) { throw std::bad_alloc(); }, ""), std::bad_alloc);
  EXPECT_THROW(run_target([](std::string_view) { require(false, "broken"); }, ""),
               std::logic_error);
}

TEST(ReplayItself, TargetsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Target& target : targets()) EXPECT_TRUE(names.insert(target.name).second);
  EXPECT_GT(names.size(), 30U);
}

TEST(ReplayItself, CutsAnInputIntoFiles) {
  const auto parts = parts_of("one\n%%\ntwo\n%%\nthree%%\n", 3);
  EXPECT_EQ(parts, (std::vector<std::string_view>{"one\n", "two\n", "three%%\n"}));
  EXPECT_EQ(parts_of("one", 3), (std::vector<std::string_view>{"one", "", ""}));
}

std::string name_of(const testing::TestParamInfo<Target>& info) { return info.param.name; }

INSTANTIATE_TEST_SUITE_P(Corpus, Replay, testing::ValuesIn(targets()), name_of);

}  // namespace
}  // namespace nadir::fuzz
