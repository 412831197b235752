// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace nadir::cli {

/// Thrown where work stops at an interrupt and has no partial result worth keeping.
struct Interrupted {};

/// From now on a first SIGINT or SIGTERM is noted and work ends at the next frame; a second one
/// ends the process at once. A closed pipe becomes a write that fails, so that files are finished.
void catch_signals();

/// Whether an interrupt was noted.
bool interrupted();

/// Throws Interrupted if so.
void stop_if_interrupted();

/// What the process ends with after an interrupt, as shells have it: 128 and the number of the
/// signal, 130 for SIGINT and 143 for SIGTERM. 0 after interrupt_is_the_end().
int interrupted_exit_code();

/// What goes on now has no end of its own: an interrupt is how it ends, and success.
void interrupt_is_the_end();

}  // namespace nadir::cli
