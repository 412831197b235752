// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "all_verbs.hpp"
#include "interrupt.hpp"
#include "program.hpp"

int main(int argc, char** argv) {
  nadir::cli::catch_signals();
  CLI::App program{"Localizes a ground robot, without GPS, in a drone's orthomosaic", "nadir"};
  nadir::cli::Invocation invocation;
  nadir::cli::add_all_verbs(program, invocation);
  return nadir::cli::run(program, invocation, argc, argv);
}
