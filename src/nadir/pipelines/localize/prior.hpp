// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "nadir/core/trajectory.hpp"
#include "nadir/localization/particle_filter.hpp"

namespace nadir {

/// Where the particles start, as typed: "X,Y,YAW_DEG" or "truth", and "METRES,DEGREES".
struct PriorOptions {
  std::string prior;
  std::string spread = "5,5";
};

struct Prior {
  Pose2 pose;
  Spread spread;
};

/// Throws Error (usage) for a text of another form or a negative spread.
Spread parse_spread(const std::string& text);

/// The start of the run with this seed. "truth" is the first pose of `truth`, moved by the seed
/// uniformly within the spread, so that it is no free start. Throws Error (usage) where there is no
/// prior, or no truth to take it from.
Prior start_of(const PriorOptions& options, const Trajectory& truth, std::uint64_t seed);

}  // namespace nadir
