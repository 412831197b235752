// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "nadir/core/sensors.hpp"

namespace nadir::ground {

/// A pair whose rows correspond: a point at depth Z is seen in the right image `disparity` pixels
/// to the left of where it is seen in the left one, Z = focal_baseline / (disparity + offset).
struct RectifiedGeometry {
  CameraModel left;               ///< without distortion, at the scale of matching
  double focal_baseline = 0.0;    ///< f b, px m
  double disparity_offset = 0.0;  ///< c_x of the right camera minus that of the left, px
  Transform3<frames::Robot, frames::Camera> robot_from_left;  ///< of the rectified camera
};

/// Brings the images of a rig into that form, and to the scale at which they are matched.
class Rectifier {
 public:
  /// Throws Error (input) for a rig without baseline, with the right camera on the left, with one
  /// camera above the other, or whose cameras differ in size.
  Rectifier(const StereoRig& rig, double scale);

  const RectifiedGeometry& geometry() const { return geometry_; }

  /// The rows from `first_row` (at the scale of matching) down.
  cv::Mat left(const Raster<std::uint8_t>& image, int first_row) const;
  cv::Mat right(const Raster<std::uint8_t>& image, int first_row) const;

 private:
  void compute_maps(const StereoRig& rig);
  cv::Mat rectify(const Raster<std::uint8_t>& image, const cv::Mat& map_xy,
                  const cv::Mat& map_fraction, int first_row) const;

  double scale_;
  bool undistorts_;
  RectifiedGeometry geometry_;
  cv::Mat left_xy_, left_fraction_, right_xy_, right_fraction_;
};

}  // namespace nadir::ground
