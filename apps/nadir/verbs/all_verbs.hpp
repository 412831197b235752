// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"

namespace nadir::cli {

/// Adds every verb, in the order of `nadir --help`.
void add_all_verbs(CLI::App& program, Invocation& invocation);

}  // namespace nadir::cli
