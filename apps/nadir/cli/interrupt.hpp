// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/stop.hpp"

namespace nadir::cli {

/// From now on a first SIGINT or SIGTERM is noted, and work ends where it next asks for it. Where
/// it does not ask within two seconds, as in the middle of a call of a library that cannot be
/// stopped, the process ends there: files have their names only when they are whole, so no more is
/// lost than by the other way; where a document is due (streams.hpp), it is printed. A second
/// signal ends the process at once. A closed pipe and a file that may not grow become writes that
/// fail.
void catch_signals();

/// Whether SIGINT or SIGTERM was noted.
bool interrupted();

/// Throws Stopped if so.
void stop_if_interrupted();

/// Why there is no result, in the document of a stopped verb.
inline constexpr const char* kStopped = "stopped by a signal";

/// Stops work at an interrupt.
StopToken interrupt_token();

/// What the process ends with after an interrupt, as shells have it: 128 and the number of the
/// signal, 130 for SIGINT and 143 for SIGTERM. 0 where an interrupt is the end.
int interrupted_exit_code();

/// Whether what goes on now has no end of its own: an interrupt is how it ends, and success.
void interrupt_is_the_end(bool is);

}  // namespace nadir::cli
