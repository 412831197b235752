// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "invocation.hpp"

namespace nadir::cli {

/// Parses the arguments and runs the chosen verb; returns the exit code: 0 done, 1 processing
/// failed, 2 usage, 3 input, 4 nothing found, 130 interrupted. A failure is one line on standard
/// error.
int run(CLI::App& program, Invocation& invocation, int argc, char** argv);

}  // namespace nadir::cli
