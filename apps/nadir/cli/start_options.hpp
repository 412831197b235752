// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"
#include "nadir/pipelines/localize/prior.hpp"

namespace nadir::cli {

/// Adds --prior and --prior-spread.
void add_start_options(CLI::App& verb, PriorOptions& start);

}  // namespace nadir::cli
