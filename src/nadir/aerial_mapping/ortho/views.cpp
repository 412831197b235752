// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/views.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/aerial_mapping/ortho/pixels.hpp"

namespace nadir::aerial {
namespace {

constexpr double kOccluderM = 0.3;  // a step of the ground that is taken for a wall
constexpr int kSteps = 24;

/// `height_at` is what hides.
template <typename HeightAt>
bool is_hidden(const View& view, double cell, const Eigen::Vector3d& point, HeightAt height_at) {
  const Eigen::Vector3d to = view.centre - point;
  const double across = std::hypot(to.x(), to.y());
  if (across < 1e-9 || to.z() <= 0.0) return false;
  // Beyond the height of a tall building nothing stands in the way.
  constexpr double kTallest = 40.0;
  const double reach = std::min(across, kTallest * across / to.z());
  const double step = std::max(cell, reach / kSteps);
  const int steps = static_cast<int>(std::floor((reach - cell) / step));
  for (int k = 0; k <= steps; ++k) {
    const double f = (cell + k * step) / across;
    const double z = point.z() + f * to.z();
    if (height_at(point.x() + f * to.x(), point.y() + f * to.y()) > z + kOccluderM) return true;
  }
  return false;
}

}  // namespace

PhotoPose pose_of(const View& view, const std::string& name) {
  PhotoPose pose;
  pose.name = name;
  pose.camera = view.camera;
  pose.map_from_camera.rotation =
      Eigen::Quaterniond(Eigen::Matrix3d(view.camera_from_map.transpose()));
  pose.map_from_camera.translation = view.centre;
  pose.flown_in_readout = view.flown;
  return pose;
}

std::optional<Sight> sight_of(const View& view, const ViewLimits& limits,
                              const Eigen::Vector3d& point) {
  const Eigen::Vector3d ray = point - view.centre;
  const Eigen::Vector3d p = view.camera_from_map * ray;
  const CameraModel& camera = view.camera;
  // Far outside the image the distortion folds back: the undistorted place must be near first.
  if (!(p.z() > 0.0)) return std::nullopt;
  const double diagonal = std::hypot(camera.width, camera.height);
  const double radius =
      std::hypot(p.x() / p.z() * camera.fx, p.y() / p.z() * camera.fy) / (0.5 * diagonal);
  if (radius > 1.3) return std::nullopt;
  const auto pixel = view.project(point);
  if (!pixel) return std::nullopt;
  Sight sight{pixel->x(), pixel->y(), 0.0, 0.0};
  const double left = std::min(sight.u, camera.width - 1.0 - sight.u);
  const double top = std::min(sight.v, camera.height - 1.0 - sight.v);
  if (left < 0.0 || top < 0.0) return std::nullopt;
  if (std::hypot(sight.u - camera.cx, sight.v - camera.cy) > 0.5 * limits.max_radius * diagonal)
    return std::nullopt;
  sight.off_nadir_rad = std::atan2(std::hypot(ray.x(), ray.y()), -ray.z());
  if (sight.off_nadir_rad > limits.max_off_nadir_rad) return std::nullopt;
  sight.edge = std::min(left / (0.5 * camera.width), top / (0.5 * camera.height));
  return sight;
}

Occlusion occlusion_of(const View& view, const Ground& ground, const Eigen::Vector3d& point) {
  const double cell = ground.heights.geo.resolution;
  if (is_hidden(view, cell, point, [&](double x, double y) { return ground.height_at(x, y); }))
    return Occlusion::kByGround;
  const bool at_foot = point.z() < ground.ramp_at(point.x(), point.y()) - 1e-3;
  if (at_foot &&
      is_hidden(view, cell, point, [&](double x, double y) { return ground.ramp_at(x, y); }))
    return Occlusion::kByARamp;
  return Occlusion::kNone;
}

std::shared_ptr<const cv::Mat> ViewImages::get(std::size_t view) {
  {
    const std::scoped_lock lock(mutex_);
    const auto found = entries_.find(view);
    if (found != entries_.end()) {
      found->second.used = ++clock_;
      return found->second.image;
    }
  }
  cv::Mat rgb = rgb_of(set_, views_[view].photo);
  const double shrink = views_[view].shrink;
  if (shrink > 1.0) {
    cv::Mat small;
    const cv::Size size(std::max(1, static_cast<int>(std::lround(rgb.cols / shrink))),
                        std::max(1, static_cast<int>(std::lround(rgb.rows / shrink))));
    cv::resize(rgb, small, size, 0.0, 0.0, cv::INTER_AREA);
    rgb = small;
  }
  auto image = std::make_shared<const cv::Mat>(rgb);
  const std::scoped_lock lock(mutex_);
  const auto [place, is_new] = entries_.emplace(view, Entry{image, ++clock_});
  if (!is_new) return place->second.image;
  held_ += rgb.total() * rgb.elemSize();
  while (held_ > budget_ && entries_.size() > 1) {
    const auto oldest = std::min_element(
        entries_.begin(), entries_.end(),
        [](const auto& a, const auto& b) { return a.second.used < b.second.used; });
    held_ -= oldest->second.image->total() * oldest->second.image->elemSize();
    entries_.erase(oldest);
  }
  return image;
}

}  // namespace nadir::aerial
