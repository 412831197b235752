// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <cstdio>

#include "cli/exit_code.hpp"
#include "cli/interrupt.hpp"
#include "cli/program.hpp"
#include "verbs/all_verbs.hpp"

int main(int argc, char** argv) try {
  nadir::cli::catch_signals();
  CLI::App program{"Localizes a ground robot, without GPS, in a drone's orthomosaic", "nadir"};
  nadir::cli::Invocation invocation;
  nadir::cli::add_all_verbs(program, invocation);
  return nadir::cli::run(program, invocation, argc, argv);
} catch (...) {
  // Before the verbs are there, only memory can be missing.
  std::fputs("nadir: error: out of memory\n", stderr);
  return static_cast<int>(nadir::cli::ExitCode::kFailed);
}
