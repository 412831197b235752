// SPDX-License-Identifier: Apache-2.0
#include "cli/verb_call.hpp"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/captured_output.hpp"
#include "cli/exit_code.hpp"
#include "cli/interrupt.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/shell.hpp"
#include "verbs/all_verbs.hpp"

namespace nadir::cli {

std::string command_line(const std::vector<std::string>& arguments) {
  return "nadir " + shell_line(arguments);
}

Json call_verb(const std::vector<std::string>& arguments, const CommonOptions& common) {
  CLI::App program{"", "nadir"};
  Invocation invocation;
  invocation.arguments = arguments;
  invocation.common.json = true;
  invocation.common.quiet = true;
  invocation.common.threads = common.threads;
  invocation.common.device = common.device;
  add_all_verbs(program, invocation);
  const CapturedOutput output;
  // CLI11 takes a vector from its end.
  program.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  const int exit_code = invocation.action();
  if (interrupted()) throw Stopped{};
  if (exit_code != static_cast<int>(ExitCode::kDone) &&
      exit_code != static_cast<int>(ExitCode::kDoubtful)) {
    throw Error(ErrorKind::kProcessing, "ended with exit code " + std::to_string(exit_code),
                command_line(arguments));
  }
  return Json::parse(output.text());
}

}  // namespace nadir::cli
