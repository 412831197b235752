// SPDX-License-Identifier: Apache-2.0
#pragma once

/// nadir localizes a ground robot in a drone's orthomosaic. The five-line use:
///
/// @code
/// const nadir::Orthomosaic map = nadir::read_orthomosaic("site/map.tif");
/// nadir::Localizer localizer{map, nadir::LocalizerOptions{}};
/// localizer.start_near({12.0, 30.5, 0.4}, {.position_m = 5.0, .yaw_rad = 0.1});
/// const nadir::Sequence drive = nadir::read_sequence("site");
/// for (const auto& local_map : drive.local_maps)
///   report(localizer.update(nadir::read_frame(drive, local_map)));  // pose, covariance, status
/// @endcode
///
/// Frames, rasters and units: docs/conventions.md. Link nadir::nadir, and nadir::io for the files.

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"
#include "nadir/evaluation/evaluation.hpp"
#include "nadir/io/drives/sequence.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "nadir/localizer.hpp"
