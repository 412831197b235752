// SPDX-License-Identifier: Apache-2.0
#pragma once

// A run of two frames in the scratch folder, whose files an input replaces.

#include "fuzz/fuzz_site.hpp"
#include "fuzz/fuzz_target.hpp"

namespace nadir::fuzz {

/// Writes site and run where they are not there yet, and gives the run's folder.
std::filesystem::path small_run();

}  // namespace nadir::fuzz
