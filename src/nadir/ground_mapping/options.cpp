// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/options.hpp"

#include <bit>

#include "nadir/core/error.hpp"
#include "nadir/ground_mapping/local_map.hpp"

namespace nadir {
namespace {

const char* const kStage = "ground_mapping.";

void declare_depth(OptionTable& table, GroundMappingOptions& options) {
  const std::string stage = kStage;
  table.number(stage + "image_scale", options.image_scale, {0.1, 1.0},
               "Scale at which stereo images are matched; 0.5 is four to five times faster and a "
               "little blurred.",
               "docs/ground-mapping.md");
  table.integer(
      stage + "disparities", options.disparities, {0.0, 1024.0},
      "Disparities searched, pixels, rounded up to a multiple of 16; 0 = what min_range_m "
      "needs, else a tenth of the image width or more for ground that is nearer.");
  table.integer(stage + "block_size", options.block_size, {3.0, 9.0},
                "Side of the matching block, pixels, odd.",
                "opencv issue 5036: artefacts above 11");
  table.number(stage + "disparity_sigma_px", options.disparity_sigma_px, {0.05, 5.0},
               "Standard deviation of a disparity, pixels.");
  table.number(stage + "max_depth_sigma_m", options.max_depth_sigma_m, {0.01, 10.0},
               "Largest standard deviation of a stereo depth that is used, metres; with "
               "max_range_m = 0 it sets the range limit.",
               "docs/ground-mapping.md, equation 4");
  table.number(stage + "min_range_m", options.min_range_m, {0.0, 100.0},
               "Nearest stereo depth, metres; 0 = from the disparities searched.");
  table.number(stage + "max_range_m", options.max_range_m, {0.0, 200.0},
               "Farthest stereo depth, metres; 0 = from max_depth_sigma_m.");
  table.number(stage + "texture_std", options.texture_std, {0.0, 50.0},
               "Smallest standard deviation of the grey values around a pixel that is matched; sky "
               "and glare lie below.");
  table.integer(stage + "min_points", options.min_points, {1.0, 100.0},
                "Points of one frame that a cell needs to be begun (stereo).");
  table.flag(stage + "check_stereo_order", options.check_stereo_order,
             "Refuse a first frame whose left and right are swapped.");
  table.number(stage + "lidar_min_range_m", options.lidar_min_range_m, {0.0, 100.0},
               "Nearest lidar range, metres: what is nearer is the vehicle itself.");
  table.number(stage + "lidar_max_range_m", options.lidar_max_range_m, {0.1, 200.0},
               "Farthest lidar range, metres.");
  table.number(stage + "lidar_range_sigma_m", options.lidar_range_sigma_m, {0.001, 1.0},
               "Standard deviation of a lidar range, metres.", "HDL-32E, elevation_mapping");
}

void declare_height(OptionTable& table, GroundMappingOptions& options) {
  const std::string stage = kStage;
  table.number(stage + "height_gate_below_m", options.height_gate_below_m, {0.1, 100.0},
               "Points lower than this under the sensor are dropped, metres.");
  table.number(stage + "height_gate_above_m", options.height_gate_above_m, {-10.0, 100.0},
               "Points higher than this over the sensor are dropped, metres.");
  table.number(stage + "height_sigma_m", options.height_sigma_m, {0.001, 1.0},
               "Standard deviation of a height beside the sensor's own noise, metres.");
  table.number(stage + "attitude_sigma_deg", options.attitude_sigma_deg, {0.0, 10.0},
               "Standard deviation of the roll and pitch of one pose, degrees.");
  table.number(stage + "gate_sigma", options.gate_sigma, {1.0, 20.0},
               "A height that differs by more standard deviations becomes the second hypothesis.",
               "docs/ground-mapping.md, equation 9");
  table.number(stage + "min_height_variance_m2", options.min_height_variance_m2, {1e-8, 1.0},
               "Variance that a cell's height does not fall below, square metres.");
  table.number(stage + "height_noise_m2_per_s", options.height_noise_m2_per_s, {0.0, 1.0},
               "Growth of a cell's height variance per second, square metres.",
               "elevation_mapping_cupy: 1e-4 at 5 Hz");
  table.number(stage + "height_drift_m2_per_m", options.height_drift_m2_per_m, {0.0, 1.0},
               "Growth of the height variance of the odometry per metre driven, square metres.");
  table.number(stage + "attitude_drift_deg", options.attitude_drift_deg, {0.0, 10.0},
               "Growth of the odometry's error in roll and pitch, degrees per square root of a "
               "metre driven.");
}

}  // namespace

std::string to_string(ColourRule rule) {
  for (const auto& [value, name] : kColourRuleNames)
    if (value == rule) return name;
  return {};
}

void declare(OptionTable& table, GroundMappingOptions& options) {
  const std::string stage = kStage;
  table.number(stage + "resolution_m", options.resolution_m, {0.01, 2.0}, "Side of a cell, metres.",
               "paper, section II");
  table.integer(
      stage + "grid_cells", options.grid_cells, {32.0, 4096.0},
      "Side of the rolling grid, cells, a power of two; what lies beyond it is forgotten.",
      "docs/ground-mapping.md: as far as the camera is used");
  declare_depth(table, options);
  declare_height(table, options);
  table.choice<ColourRule>(stage + "colour_rule", options.colour_rule, kColourRuleNames,
                           "How the colours of one cell over time become one; auto is mean for "
                           "stereo and inverse for lidar.",
                           "docs/ground-mapping.md, compared there");
  table.flag(stage + "equalise_exposure", options.equalise_exposure,
             "Multiply each frame's colours by the gain that fits it to the map.");
  table.flag(stage + "clear_seen_through", options.clear_seen_through,
             "Forget cells that later rays pass through: what has driven away.");
  table.integer(stage + "fill_cells", options.fill_cells, {0.0, 20.0},
                "Gaps in the heights of at most so many cells are interpolated, and flagged.");
  table.number(stage + "pose_jump_m", options.pose_jump_m, {0.01, 1000.0},
               "The map is dropped where the pose leaves the predicted one by more than this and "
               "3 m/s^2 allow, metres.");
  table.number(stage + "pose_jump_deg", options.pose_jump_deg, {0.01, 180.0},
               "The map is dropped where the pose leaves the predicted one by more than this and "
               "300 deg/s^2 allow, degrees.");
  table.flag(stage + "check_poses", options.check_poses,
             "Warn of poses that do not fit the images, and refuse those that plainly do not.",
             "docs/ground-mapping.md");
}

void declare(OptionTable& table, RenderOptions& options) {
  const std::string stage = "local_map.";
  table.number(stage + "size_x_m", options.size_x_m, {0.5, 400.0},
               "Length of a local map along the robot, metres.", "paper: 180 pixels");
  table.number(stage + "size_y_m", options.size_y_m, {0.5, 400.0},
               "Width of a local map across the robot, metres.", "paper: 180 pixels");
  table.number(stage + "resolution_m", options.resolution_m, {0.01, 2.0},
               "Metres per pixel of a local map.", "paper, section II");
  table.choice<MapUp>(stage + "up", options.up, kMapUpNames,
                      "Orientation of a local map: the robot's, or that of the odometry frame.");
  table.flag(stage + "ground_only", options.ground_only,
             "Leave out what stands higher than ground_only_height_m over the ground.");
  table.number(
      stage + "ground_only_height_m", options.ground_only_height_m, {0.05, 100.0},
      "Height over the plane that the robot stands on, up to which a cell counts as ground, "
      "metres.");
  table.number(stage + "low_coverage", options.low_coverage, {0.0, 1.0},
               "Share of seen pixels below which a local map is flagged.");
}

void check(const GroundMappingOptions& options) {
  const auto refuse = [](const std::string& name, const std::string& value,
                         const std::string& remedy) {
    throw Error(ErrorKind::kUsage, kStage + name + " = " + value + " is not possible", {}, remedy);
  };
  if (options.grid_cells < 2 || !std::has_single_bit(static_cast<unsigned>(options.grid_cells))) {
    refuse("grid_cells", std::to_string(options.grid_cells), "give a power of two");
  }
  if (options.block_size % 2 == 0) {
    refuse("block_size", std::to_string(options.block_size), "give an odd number");
  }
  if (options.max_range_m > 0.0 && options.max_range_m <= options.min_range_m) {
    refuse("max_range_m", to_text(options.max_range_m), "it must lie above min_range_m");
  }
  if (options.lidar_max_range_m <= options.lidar_min_range_m) {
    refuse("lidar_max_range_m", to_text(options.lidar_max_range_m),
           "it must lie above lidar_min_range_m");
  }
}

}  // namespace nadir
