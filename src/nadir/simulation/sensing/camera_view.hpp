// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "nadir/core/camera.hpp"
#include "nadir/core/frames3.hpp"
#include "nadir/core/raster.hpp"
#include "nadir/simulation/scene/scene.hpp"

namespace nadir::simulation {

using CameraPose = Transform3<frames::Map, frames::Camera>;

/// The rays (x, y, 1) of all pixels of a camera, its distortion undone once; with one pixel more on
/// every side.
class CameraRays {
 public:
  explicit CameraRays(const CameraModel& camera);

  const CameraModel& camera() const { return camera_; }
  /// Through a place of the image, pixels, by bilinear interpolation between pixel centres.
  Eigen::Vector3d at(double column, double row) const;
  Eigen::Vector3d at(int column, int row) const;

 private:
  CameraModel camera_;
  Raster<Eigen::Vector2d> rays_;
};

/// Linear radiance of every pixel. `pose_of_row` gives the camera's pose while a row is read (all
/// equal for a global shutter). Pixels on the outlines of things are averages of several rays.
Raster<float> view(const Scene& scene, const CameraRays& rays,
                   const std::function<CameraPose(int row)>& pose_of_row,
                   const Movers* movers = nullptr);

}  // namespace nadir::simulation
