// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"

namespace nadir::cli {

// One file a verb: it adds its subcommand to the program and binds its work to the invocation.
void add_simulate(CLI::App& program, Invocation& invocation);
void add_convert(CLI::App& program, Invocation& invocation);
void add_ground(CLI::App& program, Invocation& invocation);
void add_info(CLI::App& program, Invocation& invocation);
void add_map(CLI::App& program, Invocation& invocation);
void add_match(CLI::App& program, Invocation& invocation);
void add_localize(CLI::App& program, Invocation& invocation);
void add_run(CLI::App& program, Invocation& invocation);
void add_eval(CLI::App& program, Invocation& invocation);
void add_demo(CLI::App& program, Invocation& invocation);
void add_doctor(CLI::App& program, Invocation& invocation);
void add_config(CLI::App& program, Invocation& invocation);
void add_completion(CLI::App& program, Invocation& invocation);
void add_report(CLI::App& program, Invocation& invocation);
void add_view(CLI::App& program, Invocation& invocation);
void add_version(CLI::App& program, Invocation& invocation);

}  // namespace nadir::cli
