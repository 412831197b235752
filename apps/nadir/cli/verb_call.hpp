// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/invocation.hpp"
#include "cli/streams.hpp"

namespace nadir::cli {

/// Runs `nadir ARGUMENTS…` within this process, by the same code as from a shell, and gives its
/// JSON document; threads and device are those of `common`. Throws what the verb throws,
/// Stopped where it was interrupted, Error (processing) where it ended with another exit code
/// than 0 and 5; the document's `doubtful` tells these two apart.
Json call_verb(const std::vector<std::string>& arguments, const CommonOptions& common);

/// The line that a user would type for it, quoted for a shell.
std::string command_line(const std::vector<std::string>& arguments);

}  // namespace nadir::cli
