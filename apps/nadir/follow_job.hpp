// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map_job.hpp"

namespace nadir::cli {

/// Maps while photos arrive in a folder: a photo is taken once its size has stood still for half a
/// second; MAP.tif and MAP.update.json are replaced after each. Ends after `photos` photos, when
/// none has come for `idle_s`, with the map of all photos together; or at an interrupt, with the
/// map as it stands. Returns the exit code: that of map_flight, 0 after an interrupt.
int follow_flight(const MapOptions& options, const Invocation& invocation);

}  // namespace nadir::cli
