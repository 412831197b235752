// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "end_to_end/nadir_process.hpp"

namespace nadir::testing {

/// Runs with --json. The exit code must be this one, standard output exactly one document that
/// agrees with it, and the last line on standard error must say why it is not 0.
inline Outcome expect_ending(std::vector<std::string> arguments, int exit_code) {
  arguments.emplace_back("--json");
  std::string command = "nadir";
  for (const std::string& argument : arguments) command += " " + argument;
  SCOPED_TRACE(command);
  Outcome outcome = nadir(arguments);
  EXPECT_EQ(outcome.exit_code, exit_code) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output, nullptr, false);
  EXPECT_TRUE(document.is_object()) << outcome.output;
  if (!document.is_object()) return outcome;
  const bool has_result = exit_code == 0 || exit_code == 5;
  EXPECT_EQ(document.contains("error"), !has_result) << outcome.output;
  if (document.contains("error")) {
    EXPECT_EQ(document["error"]["exit_code"], exit_code);
    EXPECT_NE(document["error"]["message"], "");
  }
  const auto doubts = document.value("doubtful", nlohmann::json::array());
  if (has_result) {
    EXPECT_EQ(doubts.empty(), exit_code == 0) << outcome.output;
  }
  std::string errors = outcome.errors;
  if (errors.ends_with('\n')) errors.pop_back();
  const std::string last = errors.substr(errors.rfind('\n') + 1);
  if (exit_code == 5) {
    EXPECT_TRUE(last.starts_with("nadir: doubtful: ")) << outcome.errors;
    for (const auto& doubt : doubts) {
      EXPECT_NE(last.find(doubt.get<std::string>()), std::string::npos) << doubt;
    }
  } else if (exit_code != 0) {
    EXPECT_TRUE(last.starts_with("nadir: error: ")) << outcome.errors;
  }
  return outcome;
}

}  // namespace nadir::testing
