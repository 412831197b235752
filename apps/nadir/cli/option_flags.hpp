// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli/invocation.hpp"
#include "nadir/pipelines/effective_options.hpp"

namespace nadir::cli {

/// Adds --config and --set.
void add_config_and_set(CLI::App& verb, OptionSources& sources);
/// Adds --preset, --config, --set.
void add_option_sources(CLI::App& verb, OptionSources& sources);
/// Adds a flag that sets one option of the table; its help is the declaration's.
void add_option_flag(CLI::App& verb, OptionSources& sources, const std::string& flag,
                     const std::string& option);

}  // namespace nadir::cli
