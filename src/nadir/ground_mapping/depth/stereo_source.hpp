// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/calib3d.hpp>

#include "nadir/ground_mapping/depth/depth_source.hpp"
#include "nadir/ground_mapping/depth/rectifier.hpp"
#include "nadir/ground_mapping/options.hpp"

namespace nadir::ground {

/// Stereo depth by semi-global matching (OpenCV, three paths) of the rows below the horizon.
class StereoSource {
 public:
  using SensorFrame = StereoFrame;

  /// Throws as Rectifier does, and Error (usage) for more disparities than the image is wide.
  StereoSource(const StereoRig& rig, const GroundMappingOptions& options);

  Measurement measure(const StereoFrame& frame, const OdomPose3& odom_from_robot,
                      const RobotMotion& motion, FrameStatistics& statistics);
  std::optional<Sighting> sighting(const StereoFrame& frame) const;
  double min_range_m() const { return min_range_; }
  double max_range_m() const { return max_range_; }
  int min_points() const { return options_.min_points; }

 private:
  struct Pixels;

  cv::Mat match(const cv::Mat& left, const cv::Mat& right);
  void to_points(const Pixels& pixels, Measurement& measurement, FrameStatistics& statistics) const;
  ColourView view(const Pixels& pixels) const;

  StereoRig rig_;
  GroundMappingOptions options_;
  Rectifier rectifier_;
  int disparities_;
  double min_range_;
  double max_range_;
  cv::Ptr<cv::StereoSGBM> matcher_;
  bool order_checked_ = false;
  cv::Mat disparity_;  ///< of the frame measured last: CV_16S, 16ths of a pixel; may be empty
  int first_row_ = 0;  ///< of the image, that `disparity_` begins with
};
static_assert(DepthSource<StereoSource>);

}  // namespace nadir::ground
