// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "invocation.hpp"
#include "nadir/io/manifest.hpp"

namespace nadir::cli {

/// The manifest of this start of the program, without stages.
Manifest manifest_of(const Invocation& invocation, int threads,
                     std::vector<std::filesystem::path> inputs);

}  // namespace nadir::cli
