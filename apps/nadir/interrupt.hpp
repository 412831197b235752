// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nadir::cli {

inline constexpr int kInterruptedExitCode = 130;

/// Thrown where work stops at an interrupt and has no partial result worth keeping.
struct Interrupted {};

/// From now on a first SIGINT or SIGTERM is noted and work ends at the next frame; a second one
/// ends the process at once. A closed pipe becomes a write that fails, so that files are finished.
void catch_signals();

/// Whether an interrupt was noted.
bool interrupted();

/// Throws Interrupted if so.
void stop_if_interrupted();

}  // namespace nadir::cli
