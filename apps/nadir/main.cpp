// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <array>

#include "interrupt.hpp"
#include "program.hpp"
#include "verbs.hpp"

namespace {

constexpr std::array kVerbs{
    nadir::cli::add_simulate, nadir::cli::add_map,    nadir::cli::add_convert,
    nadir::cli::add_ground,   nadir::cli::add_info,   nadir::cli::add_match,
    nadir::cli::add_localize, nadir::cli::add_run,    nadir::cli::add_eval,
    nadir::cli::add_demo,     nadir::cli::add_doctor, nadir::cli::add_config,
    nadir::cli::add_view,     nadir::cli::add_report, nadir::cli::add_completion,
    nadir::cli::add_version,
};

}  // namespace

int main(int argc, char** argv) {
  nadir::cli::catch_signals();
  CLI::App program{"Localizes a ground robot, without GPS, in a drone's orthomosaic", "nadir"};
  nadir::cli::Invocation invocation;
  for (const auto add_verb : kVerbs) add_verb(program, invocation);
  return nadir::cli::run(program, invocation, argc, argv);
}
