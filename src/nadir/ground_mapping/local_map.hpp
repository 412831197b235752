// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "nadir/core/elevation_map.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/sensors.hpp"

namespace nadir {

/// What is up in a local map.
enum class MapUp {
  kRobot,  ///< x forward to the right, y left up: the robot frame
  kOdom,   ///< the axes of the odometry frame, the origin still at the robot
};
inline constexpr std::array<std::pair<MapUp, const char*>, 2> kMapUpNames{
    {{MapUp::kRobot, "robot"}, {MapUp::kOdom, "odom"}}};

struct RenderOptions {
  double size_x_m = 18.0;  ///< the paper's 180 pixels
  double size_y_m = 18.0;
  double resolution_m = 0.10;
  MapUp up = MapUp::kRobot;
  /// Leaves out what stands higher than `ground_only_height_m` above the plane that the robot
  /// stands on: walls and hedges are seen from the side and smear.
  bool ground_only = true;
  double ground_only_height_m = 1.0;
  /// Below this share of measured pixels a map is flagged (the first metres of a drive).
  double low_coverage = 0.6;
  /// The pose to render from; absent = that of the last frame. Two maps rendered at one pose can
  /// be compared pixel by pixel.
  std::optional<OdomPose3> at = std::nullopt;
};

void declare(OptionTable& table, RenderOptions& options);

/// Values of Orthomosaic::valid in a local map.
inline constexpr std::uint8_t kHole = 0;
inline constexpr std::uint8_t kFilledHeight = 128;  ///< height interpolated, colour really seen
inline constexpr std::uint8_t kMeasured = 255;

/// The surroundings of the robot from straight above. The rasters have one size and one
/// geo-reference, with the origin at the robot; the robot stands at the centre.
struct LocalMap {
  Stamp stamp;
  OdomPose3 odom_from_robot;
  Orthomosaic ortho;       ///< grey or RGB as the frames; valid: kHole, kFilledHeight, kMeasured
  Raster<float> weight;    ///< of the colour, 1/m^2: the sharper and the more often seen, the more
  ElevationMap elevation;  ///< above the robot's ground; also where a gap was filled
  double coverage = 0.0;   ///< share of the pixels that are no hole
  bool low_coverage = true;  ///< coverage < RenderOptions::low_coverage
  /// Height of the ground at the robot in the odometry frame, from the cells around it; absent
  /// while too few were seen. Poses need not know how high the camera stands.
  std::optional<double> ground_in_odom_m = std::nullopt;
};

/// The share of pixels that are no hole in the centred square of the given side.
double coverage_of(const LocalMap& map, double size_m);

}  // namespace nadir
