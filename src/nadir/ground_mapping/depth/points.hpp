// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "nadir/core/camera.hpp"
#include "nadir/core/frames3.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/statistics.hpp"

namespace nadir::ground {

/// A pixel above this grey level is saturated: it says little about the colour, and weighs so much
/// less.
inline constexpr int kSaturated = 250;
inline constexpr float kSaturatedWeight = 0.2F;

/// One measured point of a surface. Relative to the sensor, so that float suffices wherever the
/// robot is; along the axes of the odometry frame.
struct SurfacePoint {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;
  float height_variance = 0.0F;  ///< m^2, equation 3
  float colour_weight = 0.0F;    ///< 1/m^2; 0 = no camera saw it
  std::array<std::uint8_t, 3> colour{};
};

/// The points of a frame in stripes that are filled in parallel; their number and order depend on
/// the frame alone.
using PointStripes = std::vector<std::vector<SurfacePoint>>;

/// A camera of this frame, for looking up the colour of a cell.
struct ColourView {
  Raster<std::uint8_t> image;  ///< 1 or 3 channels
  CameraModel model;
  Transform3<frames::Odom, frames::Camera> odom_from_camera;
  /// Depth of what is seen at pixel (u, v) / depth_step; infinity where nothing is known. A cell
  /// farther than that by `depth_slack_m` + depth_sigma_per_m2 * depth^2 is hidden.
  Raster<float> depth;
  int depth_step = 1;
  float depth_slack_m = 0.3F;
  float depth_sigma_per_m2 = 0.0F;
};

/// What a depth sensor makes of a frame.
struct Measurement {
  MappingStatus status = MappingStatus::kOk;
  Eigen::Vector3d sensor_in_odom = Eigen::Vector3d::Zero();
  PointStripes points;
  std::vector<ColourView> views;  ///< where the colour rule asks for them
  int channels = 1;               ///< of the colours
};

/// How the robot moves while a sweep is taken.
struct RobotMotion {
  Transform3<frames::Robot, frames::Robot> step;  ///< over `duration_s`; the robot frame at its end
  double duration_s = 0.0;                        ///< 0 = not known
};

}  // namespace nadir::ground
