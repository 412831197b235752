// SPDX-License-Identifier: Apache-2.0
// Endings that no command line brings about on demand.
#include "cli/program.hpp"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli/interrupt.hpp"
#include "cli/verdict.hpp"
#include "nadir/core/error.hpp"
#include "nadir/core/stop.hpp"
#include "support/temporary_folder.hpp"

namespace nadir::cli {
namespace {

struct Ended {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

/// Runs a program whose one verb does this.
Ended end_of(const std::function<int(const Invocation&)>& work, bool json = true) {
  CLI::App program{"", "nadir"};
  Invocation invocation;
  CLI::App* verb = program.add_subcommand("work", "");
  add_output_style(*verb, invocation.common);
  verb->callback([&] { invocation.action = [&] { return work(invocation); }; });
  std::array<std::string, 3> words{"nadir", "work", "--json"};
  std::array<char*, 3> arguments{words[0].data(), words[1].data(), words[2].data()};
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Ended ended;
  ended.exit_code = run(program, invocation, json ? 3 : 2, arguments.data());
  ended.output = testing::internal::GetCapturedStdout();
  ended.errors = testing::internal::GetCapturedStderr();
  return ended;
}

void expect_error_document(const Ended& ended, int exit_code, const std::string& part) {
  EXPECT_EQ(ended.exit_code, exit_code);
  const Json document = Json::parse(ended.output, nullptr, false);
  ASSERT_TRUE(document.is_object()) << ended.output;
  EXPECT_EQ(document["error"]["exit_code"], exit_code);
  EXPECT_NE(document["error"]["message"].get<std::string>().find(part), std::string::npos)
      << document["error"]["message"];
}

TEST(Program, EveryExceptionBecomesOneDocument) {
  expect_error_document(end_of([](const auto&) -> int { throw std::bad_alloc(); }), 1,
                        "out of memory");
  expect_error_document(end_of([](const auto&) -> int { throw std::runtime_error("a \xe9"); }), 1,
                        "a \xef\xbf\xbd");
  expect_error_document(
      end_of([](const auto&) -> int { throw Error(ErrorKind::kInput, "bad", "caf\xe9"); }), 3,
      "caf\xef\xbf\xbd: bad");
  expect_error_document(end_of([](const auto&) -> int {
                          throw std::filesystem::filesystem_error(
                              "status", "a/b", std::make_error_code(std::errc::io_error));
                        }),
                        1, "a/b: ");
  expect_error_document(end_of([](const auto&) -> int { throw Stopped{}; }),
                        interrupted_exit_code(), "stopped");
}

TEST(Program, AStepThatCannotBeInterruptedEndsWithTheDocumentThatIsDue) {
  const test::TemporaryFolder folder;
  const std::string file = (folder / "stdout").string();
  const auto stuck = [&](int signal) {
    catch_signals();
    if (std::freopen(file.c_str(), "w", stdout) == nullptr) std::abort();
    expect_document(true);
    std::raise(signal);
    for (;;) std::this_thread::sleep_for(std::chrono::seconds(1));
  };
  for (const int signal : {SIGINT, SIGTERM}) {
    const int code = 128 + signal;
    EXPECT_EXIT(stuck(signal), testing::ExitedWithCode(code), "within a step");
    EXPECT_EQ(Json::parse(test::read_text(file), nullptr, false),
              error_document("stopped by a signal", code));
  }
}

TEST(Program, WithoutJsonStandardOutputStaysEmpty) {
  const Ended ended = end_of([](const auto&) -> int { throw std::bad_alloc(); }, false);
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(ended.output, "");
  EXPECT_TRUE(ended.errors.starts_with("nadir: error: out of memory")) << ended.errors;
}

TEST(Program, AFailureBehindTheResultAddsNoSecondDocument) {
  const Ended ended = end_of([](const auto& invocation) -> int {
    finish({{"a", 1}}, "", {}, invocation.common);
    throw std::runtime_error("late");
  });
  EXPECT_EQ(ended.exit_code, 1);
  EXPECT_EQ(Json::parse(ended.output, nullptr, false)["a"], 1) << ended.output;
  EXPECT_EQ(ended.errors, "nadir: error: late\n");
}

TEST(Program, AMessageIsOneLineWhateverTheNameHolds) {
  const Ended ended = end_of(
      [](const auto&) -> int { throw Error(ErrorKind::kInput, "bad", "a\nb\033[31m\rc"); }, false);
  EXPECT_EQ(ended.errors, "nadir: error: a b [31m c: bad\n");
}

}  // namespace
}  // namespace nadir::cli
