// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "nadir/ground_mapping/grid/aggregator.hpp"
#include "nadir/ground_mapping/grid/elevation_grid.hpp"
#include "nadir/ground_mapping/options.hpp"
#include "nadir/ground_mapping/statistics.hpp"

namespace nadir::ground {

/// When and where on the way a frame was taken, since the map began.
struct Progress {
  std::uint32_t milliseconds = 0;
  std::uint32_t odometer_mm = 0;
  std::uint8_t frame = 0;  ///< low bits of its number
};

/// Brings the measurements of one frame into the grid: one Kalman update of the height per cell
/// (equations 8 and 9), then the colours (equation 11).
class Fuser {
 public:
  explicit Fuser(const GroundMappingOptions& options) : options_(options) {}

  /// Heights; marks in `cells` what was accepted. `min_points` holds for cells not yet known.
  void fuse_heights(Aggregator& cells, ElevationGrid& grid, const Eigen::Vector3d& sensor_in_odom,
                    Progress now, int min_points, FrameStatistics& statistics) const;

  /// Colours of the accepted cells by `rule`, after the gain that fits the frame to the map.
  void fuse_colours(const Aggregator& cells, ElevationGrid& grid, ColourRule rule,
                    FrameStatistics& statistics) const;

 private:
  GroundMappingOptions options_;
};

/// The gain that fits the colours of a frame to those of the map: the median ratio over the cells
/// that both have, within 0.8 .. 1.25; 1 where they share too few.
class ExposureGain {
 public:
  void compare(const Cell& cell, const std::array<float, 3>& colour);
  double value();

 private:
  std::vector<float> log_ratios_;
};

/// Blends one colour of a frame into a cell (equation 11).
void blend_colour(Cell& cell, ColourRule rule, float weight, float red, float green, float blue);

/// Makes the second hypothesis the cell's height; its colours are forgotten with the first. A cell
/// without a rival becomes unknown.
void promote_second(Cell& cell);

}  // namespace nadir::ground
