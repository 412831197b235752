// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/resection.hpp"

#include <opencv2/calib3d.hpp>
#include <vector>

namespace nadir::aerial {

bool resect(Model& model, std::size_t photo, int fewest, double threshold_px, std::uint64_t seed) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  bool first = true;
  for (const Landmark& landmark : model.landmarks) {
    if (!landmark.valid) continue;
    for (const Observation& seen : landmark.track) {
      if (seen.photo != photo) continue;
      if (first) origin = landmark.position;
      first = false;
      const Eigen::Vector3d p = landmark.position - origin;
      points.emplace_back(p.x(), p.y(), p.z());
      pixels.emplace_back(seen.u, seen.v);
    }
  }
  if (static_cast<int>(points.size()) < fewest) return false;
  const CameraModel& camera = model.camera(photo);
  const cv::Matx33d matrix(camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1);
  const cv::Vec<double, 5> distortion(camera.k1, camera.k2, camera.p1, camera.p2, camera.k3);
  cv::Mat rotation;
  cv::Mat translation;
  std::vector<int> inliers;
  cv::theRNG().state = seed | 1U;
  try {
    if (!cv::solvePnPRansac(points, pixels, matrix, distortion, rotation, translation, false, 1000,
                            static_cast<float>(threshold_px), 0.999, inliers, cv::SOLVEPNP_SQPNP))
      return false;
  } catch (const cv::Exception&) {
    return false;  // a degenerate sample
  }
  if (static_cast<int>(inliers.size()) < fewest) return false;
  std::vector<cv::Point3d> good_points;
  std::vector<cv::Point2d> good_pixels;
  for (const int i : inliers) {
    good_points.push_back(points[static_cast<std::size_t>(i)]);
    good_pixels.push_back(pixels[static_cast<std::size_t>(i)]);
  }
  cv::solvePnPRefineLM(good_points, good_pixels, matrix, distortion, rotation, translation);
  cv::Matx33d r;
  cv::Rodrigues(rotation, r);
  Pose pose;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) pose.camera_from_map(row, column) = r(row, column);
  const Eigen::Vector3d t{translation.at<double>(0), translation.at<double>(1),
                          translation.at<double>(2)};
  pose.centre = origin - pose.camera_from_map.transpose() * t;
  pose.known = pose.centre.allFinite() && pose.camera_from_map.allFinite();
  if (!pose.known) return false;
  model.poses[photo] = pose;
  return true;
}

}  // namespace nadir::aerial
