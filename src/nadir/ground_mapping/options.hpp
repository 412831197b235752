// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <utility>

#include "nadir/core/options.hpp"

namespace nadir {

/// How the colours that a cell was seen in over time become one.
enum class ColourRule {
  kAuto,       ///< mean for stereo, inverse for lidar
  kMean,       ///< mean of all views, weighted by how sharply each saw the cell
  kNearest,    ///< the sharpest view alone
  kOverwrite,  ///< the last view alone, as in GEM; for comparison
  kInverse,    ///< each cell is looked up in the image, then as mean; fills the gaps between rows
};
inline constexpr std::array<std::pair<ColourRule, const char*>, 5> kColourRuleNames{
    {{ColourRule::kAuto, "auto"},
     {ColourRule::kMean, "mean"},
     {ColourRule::kNearest, "nearest"},
     {ColourRule::kOverwrite, "overwrite"},
     {ColourRule::kInverse, "inverse"}}};
std::string to_string(ColourRule rule);

/// One set of defaults serves every rig: what depends on the camera is derived from it where the
/// option is 0. Equations: docs/ground-mapping.md.
struct GroundMappingOptions {
  // the grid
  double resolution_m = 0.10;
  int grid_cells = 512;
  // stereo
  double image_scale = 1.0;
  int disparities = 0;
  int block_size = 5;
  double disparity_sigma_px = 0.5;
  double max_depth_sigma_m = 0.8;
  double min_range_m = 0.0;
  double max_range_m = 0.0;
  double texture_std = 1.0;
  int min_points = 2;
  bool check_stereo_order = true;
  // lidar
  double lidar_min_range_m = 1.0;
  double lidar_max_range_m = 30.0;
  double lidar_range_sigma_m = 0.02;
  // height
  double height_gate_below_m = 3.5;
  double height_gate_above_m = 0.5;
  double height_sigma_m = 0.03;
  double attitude_sigma_deg = 0.05;
  double gate_sigma = 3.0;
  double min_height_variance_m2 = 1e-4;
  double height_noise_m2_per_s = 5e-4;
  double height_drift_m2_per_m = 1e-5;
  double attitude_drift_deg = 0.02;
  // colour
  ColourRule colour_rule = ColourRule::kAuto;
  bool equalise_exposure = true;
  // upkeep
  bool clear_seen_through = true;
  int fill_cells = 3;
  double pose_jump_m = 0.3;
  double pose_jump_deg = 2.0;
  bool check_poses = true;
};

void declare(OptionTable& table, GroundMappingOptions& options);

/// Throws Error (usage) where two options contradict each other (grid_cells no power of two, an
/// even block size, max_range below min_range).
void check(const GroundMappingOptions& options);

}  // namespace nadir
