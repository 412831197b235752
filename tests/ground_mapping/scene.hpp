// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/local_map.hpp"

namespace nadir::test {

/// A box that stands on the ground.
struct Box {
  double x_min = 0.0, x_max = 0.0, y_min = 0.0, y_max = 0.0, height = 0.0;
};

/// A textured world with exact geometry: ground at 0, higher by `kerb_height` where y > kerb_y,
/// rising along x from `ramp_x` on, with boxes. Rays are cast in closed form.
struct Scene {
  double kerb_y = 1e9;
  double kerb_height = 0.0;
  double ramp_x = 1e9;
  double ramp_slope = 0.0;
  std::vector<Box> boxes;
  double texture_m = 0.25;  ///< the finest wavelength of the texture
  double grain = 0.0;       ///< grey values of a texture of 5 cm, as asphalt has for the matching
  double brightness = 1.0;

  double ground(double x, double y) const;
  /// Grey value at a point of a surface, 0 .. 255.
  double grey(const Eigen::Vector3d& place) const;
  /// How far the ray goes until it meets something, in lengths of `direction`; infinity = sky.
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
};

/// A level stereo rig, its cameras `height` over the robot's ground and `pitch_rad` downwards.
StereoRig make_rig(double height, double pitch_rad, int width, int image_height, double focal,
                   double baseline);

/// Small images, quick to match.
StereoRig small_rig();

/// The image of the scene that a camera sees, four rays a pixel; the sky is 200.
Raster<std::uint8_t> photograph(const Scene& scene, const CameraModel& camera,
                                const Transform3<frames::Odom, frames::Camera>& odom_from_camera);

StereoFrame photograph(const Scene& scene, const StereoRig& rig, const OdomPose3& pose,
                       Stamp stamp);

/// A lidar at 1.2 m, and a camera over it at 2.5 m that looks forward and 40 degrees down.
LidarRig make_lidar_rig();

/// A sweep without points and images.
LidarFrame sweep_at(Stamp stamp);

/// Grey and height as they are, under the pixels of a local map.
struct Truth {
  Raster<float> grey;
  Raster<float> height;  ///< NaN near edges, where a cell holds two heights
};
Truth truth_under(const Scene& scene, const LocalMap& map);

struct Agreement {
  double zncc = 0.0;
  double shift_columns = 0.0;  ///< to a fraction of a pixel, where the correlation peaks
  double shift_rows = 0.0;
  double height_rmse_m = 0.0;
  double compared = 0.0;  ///< share of the pixels
};
Agreement agreement(const Truth& truth, const LocalMap& map, double radius_m = 1e9);

/// Of a sensor that measures ten times a second.
Stamp at_step(int number);

/// The robot on its way: at x, level, heading `yaw`, `z` = ground.
OdomPose3 pose_at(double x, double y, double yaw, double z = 0.0);

}  // namespace nadir::test
