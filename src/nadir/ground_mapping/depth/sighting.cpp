// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/depth/sighting.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "nadir/ground_mapping/depth/images.hpp"

namespace nadir::ground {
namespace {

constexpr int kMostCorners = 60;
/// A corner is as good as this share of the best one.
constexpr double kCornerQuality = 0.02;
constexpr double kSpacing = 12.0;  // px

}  // namespace

Sighting sighting_of(const cv::Mat& image, const CameraModel& camera,
                     const Transform3<frames::Robot, frames::Camera>& robot_from_camera) {
  Sighting sighting;
  sighting.camera =
      scaled(camera, std::min(1.0, static_cast<double>(kSightingWidth) / camera.width));
  sighting.robot_from_camera = robot_from_camera;
  cv::resize(grey_of(image), sighting.grey, {sighting.camera.width, sighting.camera.height}, 0.0,
             0.0, cv::INTER_AREA);
  return sighting;
}

void find_landmarks(Sighting& sighting, const cv::Mat& depth) {
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(sighting.grey, corners, kMostCorners, kCornerQuality, kSpacing,
                          depth > 0.0F);
  for (const cv::Point2f& corner : corners) {
    const Eigen::Vector2i pixel(cvRound(corner.x), cvRound(corner.y));
    const double z = depth.at<float>(pixel.y(), pixel.x());
    sighting.landmarks.push_back({pixel, z * sighting.camera.ray(pixel.cast<double>())});
  }
}

}  // namespace nadir::ground
