// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/stereo_order.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>

#include "nadir/ground_mapping/depth/images.hpp"
#include "nadir/ground_mapping/depth/rectifier.hpp"

namespace nadir {
namespace {

/// The share of the pixels, beyond the strip that the search cannot reach, that find a partner:
/// by a matching that is strict, where that of the mapping forgives.
double matched_share(const cv::Mat& left, const cv::Mat& right, int disparities, int block) {
  const auto matcher =
      cv::StereoSGBM::create(0, disparities, block, 8 * block * block, 32 * block * block, 1, 31,
                             15, 100, 2, cv::StereoSGBM::MODE_SGBM_3WAY);
  cv::Mat disparity;
  matcher->compute(left, right, disparity);
  const cv::Mat part = disparity.colRange(disparities, disparity.cols);
  return static_cast<double>(cv::countNonZero(part > 0)) / static_cast<double>(part.total());
}

}  // namespace

StereoOrder stereo_order(const StereoRig& rig, const StereoFrame& frame,
                         const GroundMappingOptions& options) {
  ground::check_image(frame.left, rig.left, "left");
  ground::check_image(frame.right, rig.right, "right");
  const ground::Rectifier rectifier(rig, std::min(0.5, options.image_scale));
  // The lower half: what is near, where the disparities are large and a wrong sign is plain.
  const int first_row = rectifier.geometry().left.height / 2;
  const cv::Mat left = ground::grey_of(rectifier.left(frame.left, first_row));
  const cv::Mat right = ground::grey_of(rectifier.right(frame.right, first_row));
  const int disparities = std::max(16, left.cols / 10 / 16 * 16 + 16);
  if (left.cols <= disparities + 32) return {};
  const double as_given = matched_share(left, right, disparities, options.block_size);
  // NOLINTNEXTLINE(readability-suspicious-call-argument): as if they had been swapped
  const double swapped = matched_share(right, left, disparities, options.block_size);
  return {as_given, swapped};
}

}  // namespace nadir
