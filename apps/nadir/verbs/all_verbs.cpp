// SPDX-License-Identifier: Apache-2.0
#include "verbs/all_verbs.hpp"

#include <CLI/CLI.hpp>
#include <array>

#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

constexpr std::array kVerbs{
    add_simulate, add_map,    add_convert,    add_ground,  add_info,   add_match,
    add_localize, add_run,    add_eval,       add_demo,    add_doctor, add_config,
    add_view,     add_report, add_completion, add_version,
};

}  // namespace

void add_all_verbs(CLI::App& program, Invocation& invocation) {
  for (const auto add_verb : kVerbs) add_verb(program, invocation);
}

}  // namespace nadir::cli
