// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli/invocation.hpp"

namespace nadir::cli {

/// `convert map`, under `parent`, the verb convert.
void add_convert_map(CLI::App& parent, Invocation& invocation);

}  // namespace nadir::cli
