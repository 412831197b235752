// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "nadir/core/frames.hpp"
#include "nadir/map_matching/matching.hpp"

namespace nadir::cli {

/// Where to look, as typed.
struct RegionOptions {
  std::optional<double> window_m;  ///< half the side; absent = the whole map
  std::string centre;              ///< "X,Y"
  std::optional<double> yaw_deg;
  double yaw_range_deg = 0.0;  ///< half the range
};

struct RegionChoice {
  SearchRegion region;
  std::string explanation;  ///< for the reader: where centre and heading come from
};

/// The search region. A window around the truth is moved off it by the seed, by up to half its half
/// side, so that the centre of the window tells nothing. Throws Error (usage) where centre or
/// heading is needed and not known.
RegionChoice choose_region(const RegionOptions& options, const std::optional<Pose2>& truth,
                           std::uint64_t seed);

}  // namespace nadir::cli
