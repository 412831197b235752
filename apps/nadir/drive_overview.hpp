// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/trajectory.hpp"
#include "nadir/ground_mapping/local_map.hpp"
#include "nadir/io/drives/drive_reader.hpp"

namespace nadir::cli {

/// All local maps of a drive laid into one picture of the odometry frame, for a look at the whole:
/// where several saw a place, the one with the most weight shows.
class DriveOverview {
 public:
  /// Large enough for local maps of this half diagonal along the poses; the resolution is that of
  /// the local maps, or coarser where the picture would be larger than 3000 pixels.
  DriveOverview(const std::vector<StampedOdomPose3>& poses, double reach_m, double resolution_m);

  void add(const LocalMap& map);

  const Orthomosaic& mosaic() const { return mosaic_; }
  /// With the poses on it.
  Raster<std::uint8_t> draw(const Odometry& odometry, const std::string& title) const;

 private:
  Orthomosaic mosaic_;  ///< RGB
  Raster<float> weight_;
};

}  // namespace nadir::cli
