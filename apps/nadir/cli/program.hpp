// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"

namespace nadir::cli {

/// Parses the arguments and runs the chosen verb; returns the exit code (exit_code.hpp). A failure
/// is one line on standard error. With --json standard output gets one document, however it ends;
/// help alone stays text.
int run(CLI::App& program, Invocation& invocation, int argc, char** argv);

}  // namespace nadir::cli
