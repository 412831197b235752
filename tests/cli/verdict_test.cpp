// SPDX-License-Identifier: Apache-2.0
#include "cli/verdict.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>

namespace nadir::cli {
namespace {

TEST(Verdict, ASoundResultIsDone) {
  const Verdict verdict;
  Json document{{"a", 1}};
  add_verdict(document, verdict);
  EXPECT_EQ(document, (Json{{"a", 1}, {"doubtful", Json::array()}}));
  testing::internal::CaptureStderr();
  EXPECT_EQ(conclude(verdict), 0);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Verdict, DoubtsAreSaidOnceInTheLastLine) {
  Verdict verdict(std::vector<std::string>{"the scale is arbitrary"});
  verdict.doubt("a part is missing");
  verdict.doubt("the scale is arbitrary");
  Json document = Json::object();
  add_verdict(document, verdict);
  EXPECT_EQ(document["doubtful"], (Json{"the scale is arbitrary", "a part is missing"}));
  EXPECT_FALSE(document.contains("error"));
  testing::internal::CaptureStderr();
  EXPECT_EQ(conclude(verdict), 5);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "nadir: doubtful: the scale is arbitrary. And: a part is missing\n");
}

TEST(Verdict, NothingFoundIsAnErrorOfItsOwnCode) {
  Verdict verdict(std::vector<std::string>{"and doubtful"});
  verdict.nothing_found({ErrorKind::kNoResult, "no pose", "site"});
  Json document = Json::object();
  add_verdict(document, verdict);
  EXPECT_EQ(document["error"], (Json{{"message", "site: no pose"}, {"exit_code", 4}}));
  testing::internal::CaptureStderr();
  EXPECT_EQ(conclude(verdict), 4);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "nadir: doubtful: and doubtful\nnadir: error: site: no pose\n");
}

TEST(ExitCodes, AreEachThereOnceAndInOrder) {
  std::set<int> codes;
  int before = -1;
  for (const ExitCodeMeaning& row : kExitCodes) {
    const int code = static_cast<int>(row.code);
    EXPECT_GT(code, before);
    before = code;
    codes.insert(code);
  }
  EXPECT_EQ(codes, (std::set<int>{0, 1, 2, 3, 4, 5, 130, 143}));
}

TEST(ExitCodes, AreDocumentedAsTheProgramHasThem) {
  std::ifstream file("docs/exit-codes.md");
  const std::string page{std::istreambuf_iterator<char>(file), {}};
  EXPECT_NE(page.find(exit_codes_in_markdown()), std::string::npos)
      << "docs/exit-codes.md must hold this table:\n"
      << exit_codes_in_markdown();
}

}  // namespace
}  // namespace nadir::cli
