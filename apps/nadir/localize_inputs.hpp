// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "localize_job.hpp"
#include "nadir/io/drives/sequence.hpp"

namespace nadir::cli {

/// Whether the odometry of the site is used: `odometry` is "file", "maps", or empty for the file
/// where there is one. Throws Error (usage) for a file that is not there.
bool uses_odometry_file(const std::string& odometry, const Sequence& sequence);

/// The frames asked for. Where none are named, a start at the truth begins at the first frame that
/// has one: the prior would not hold for the frames before it. Says so, unless `quiet`.
std::vector<Sequence::LocalMap> frames_of(const LocalizeOptions& options, const Sequence& sequence,
                                          bool quiet);

/// Says so where the odometry does not cover the frames: the local maps stand in for it.
void note_coverage(const Odometry& odometry, const std::vector<Sequence::LocalMap>& frames,
                   bool quiet);

}  // namespace nadir::cli
