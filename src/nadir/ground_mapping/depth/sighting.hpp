// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "nadir/core/camera.hpp"
#include "nadir/core/frames3.hpp"

namespace nadir::ground {

/// A corner of the image whose depth is known.
struct Landmark {
  Eigen::Vector2i pixel;
  Eigen::Vector3d p_in_camera;
};

/// A frame as the check of the poses sees it. Nothing in it depends on a pose.
struct Sighting {
  cv::Mat grey;        ///< its own, at most kSightingWidth wide
  CameraModel camera;  ///< of `grey`
  Transform3<frames::Robot, frames::Camera> robot_from_camera;
  std::vector<Landmark> landmarks;
};

inline constexpr int kSightingWidth = 640;

/// A sighting without landmarks of a grey or RGB image, which is shrunk where it is wider.
Sighting sighting_of(const cv::Mat& image, const CameraModel& camera,
                     const Transform3<frames::Robot, frames::Camera>& robot_from_camera);

/// Finds the corners of `sighting.grey` where `depth` (CV_32F of the same size, metres, 0 =
/// unknown) knows how far they are.
void find_landmarks(Sighting& sighting, const cv::Mat& depth);

}  // namespace nadir::ground
