// SPDX-License-Identifier: Apache-2.0
#include "drive_overview.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/report/figures.hpp"

namespace nadir::cli {
namespace {

constexpr double kLargestSidePx = 3000.0;

}  // namespace

DriveOverview::DriveOverview(const std::vector<StampedOdomPose3>& poses, double reach_m,
                             double resolution_m) {
  Eigen::Vector2d low = poses.front().odom_from_robot.translation.head<2>();
  Eigen::Vector2d high = low;
  for (const StampedOdomPose3& pose : poses) {
    low = low.cwiseMin(pose.odom_from_robot.translation.head<2>());
    high = high.cwiseMax(pose.odom_from_robot.translation.head<2>());
  }
  low.array() -= reach_m;
  high.array() += reach_m;
  const Eigen::Vector2d extent = high - low;
  const double resolution = std::max(resolution_m, extent.maxCoeff() / kLargestSidePx);
  const int width = static_cast<int>(std::ceil(extent.x() / resolution));
  const int height = static_cast<int>(std::ceil(extent.y() / resolution));
  mosaic_ = {Raster<std::uint8_t>(width, height, 0, 3),
             Raster<std::uint8_t>(width, height),
             {low.x(), high.y(), resolution, {}}};
  weight_ = Raster<float>(width, height, 0.0F);
}

void DriveOverview::add(const LocalMap& map) {
  const GeoReference& geo = mosaic_.geo;
  const GeoReference& local = map.ortho.geo;
  const OdomPose2 pose = planar(map.odom_from_robot);
  const auto robot_from_odom = pose.inverse();
  const double reach = std::hypot(map.ortho.width(), map.ortho.height()) / 2.0 * local.resolution;
  const PixelCoordinate first = geo.pixel_at(pose.x - reach, pose.y + reach);
  const PixelCoordinate last = geo.pixel_at(pose.x + reach, pose.y - reach);
  const int channels = map.ortho.image.channels();
  for (int row = std::max(0, static_cast<int>(first.row));
       row < std::min(mosaic_.height(), static_cast<int>(last.row) + 1); ++row) {
    for (int column = std::max(0, static_cast<int>(first.column));
         column < std::min(mosaic_.width(), static_cast<int>(last.column) + 1); ++column) {
      const auto p_in_robot =
          robot_from_odom * Point2<frames::Odom>{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      const PixelCoordinate pixel = local.pixel_at(p_in_robot.x, p_in_robot.y);
      const int u = static_cast<int>(std::floor(pixel.column));
      const int v = static_cast<int>(std::floor(pixel.row));
      if (!map.ortho.valid.contains(u, v) || map.ortho.valid.at(u, v) == 0) continue;
      const float weight = map.weight.at(u, v);
      if (mosaic_.valid.at(column, row) != 0 && weight <= weight_.at(column, row)) continue;
      for (int c = 0; c < 3; ++c) {
        mosaic_.image.at(column, row, c) = map.ortho.image.at(u, v, channels == 3 ? c : 0);
      }
      mosaic_.valid.at(column, row) = 255;
      weight_.at(column, row) = weight;
    }
  }
}

Raster<std::uint8_t> DriveOverview::draw(const Odometry& odometry, const std::string& title) const {
  // A figure knows one frame; the odometry's stands in for the map's.
  Track track{"odometry", {}};
  for (const auto& [stamp, pose] : odometry) {
    track.trajectory.push_back({stamp, {pose.x, pose.y, pose.yaw}});
  }
  return draw_trajectories(mosaic_, {track}, title, {.whole_map = true, .north_arrow = false});
}

}  // namespace nadir::cli
