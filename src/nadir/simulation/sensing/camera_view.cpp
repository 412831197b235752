// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/sensing/camera_view.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace nadir::simulation {
namespace {

/// What the pixels of an image met, to find outlines.
struct Seen {
  std::int32_t thing = 0;
  float depth = 0.0F;
};

struct Shot {
  Eigen::Vector3d origin;
  Eigen::Matrix3d rotation;
};

}  // namespace

CameraRays::CameraRays(const CameraModel& camera)
    : camera_(camera), rays_(camera.width + 2, camera.height + 2, Eigen::Vector2d::Zero()) {
  tbb::parallel_for(0, rays_.height(), [&](int row) {
    for (int column = 0; column < rays_.width(); ++column) {
      rays_.at(column, row) = camera_.ray(Eigen::Vector2d(column - 1, row - 1)).head<2>();
    }
  });
}

Eigen::Vector3d CameraRays::at(int column, int row) const {
  const Eigen::Vector2d& ray = rays_.at(column + 1, row + 1);
  return {ray.x(), ray.y(), 1.0};
}

Eigen::Vector3d CameraRays::at(double column, double row) const {
  const double u = std::clamp(column + 1.0, 0.0, rays_.width() - 1.001);
  const double v = std::clamp(row + 1.0, 0.0, rays_.height() - 1.001);
  const int c = static_cast<int>(u);
  const int r = static_cast<int>(v);
  const Eigen::Vector2d above = rays_.at(c, r) + (u - c) * (rays_.at(c + 1, r) - rays_.at(c, r));
  const Eigen::Vector2d below =
      rays_.at(c, r + 1) + (u - c) * (rays_.at(c + 1, r + 1) - rays_.at(c, r + 1));
  const Eigen::Vector2d ray = above + (v - r) * (below - above);
  return {ray.x(), ray.y(), 1.0};
}

Raster<float> view(const Scene& scene, const CameraRays& rays,
                   const std::function<CameraPose(int row)>& pose_of_row, const Movers* movers) {
  const CameraModel& camera = rays.camera();
  Raster<float> image(camera.width, camera.height, 0.0F, 3);
  Raster<Seen> seen(camera.width, camera.height);
  std::vector<Shot> shots(static_cast<std::size_t>(camera.height));
  for (int row = 0; row < camera.height; ++row) {
    const CameraPose pose = pose_of_row(row);
    shots[static_cast<std::size_t>(row)] = {pose.translation, pose.rotation.toRotationMatrix()};
  }
  const double pixel = 1.0 / camera.fx;
  const auto look = [&](const Shot& shot, const Eigen::Vector3d& ray, double width,
                        Seen* what) -> Eigen::Vector3f {
    const Eigen::Vector3d direction = shot.rotation * ray;
    const RayHit hit = scene.caster().cast(shot.origin, direction, 0.0, 1e9, movers);
    if (what != nullptr) {
      const bool solid = hit.solid >= 0;
      *what = {solid ? static_cast<std::int32_t>(hit.solid) : hit.solid, static_cast<float>(hit.t)};
    }
    // With rays of z = 1, t is the depth and t / fx the width of a pixel there.
    return scene.colour(shot.origin, direction, hit, width * hit.t, movers);
  };
  tbb::parallel_for(0, camera.height, [&](int row) {
    for (int column = 0; column < camera.width; ++column) {
      const Eigen::Vector3f colour = look(shots[static_cast<std::size_t>(row)],
                                          rays.at(column, row), pixel, &seen.at(column, row));
      for (int k = 0; k < 3; ++k) image.at(column, row, k) = colour[k];
    }
  });
  const auto on_outline = [&](int column, int row) {
    const std::int32_t thing = seen.at(column, row).thing;
    return (column + 1 < camera.width && seen.at(column + 1, row).thing != thing) ||
           (row + 1 < camera.height && seen.at(column, row + 1).thing != thing) ||
           (column > 0 && seen.at(column - 1, row).thing != thing) ||
           (row > 0 && seen.at(column, row - 1).thing != thing);
  };
  tbb::parallel_for(0, camera.height, [&](int row) {
    for (int column = 0; column < camera.width; ++column) {
      if (!on_outline(column, row)) continue;
      // The corners of a turned square: four rays whose mean lies at the centre.
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (const auto& [du, dv] : {std::pair{-0.375, -0.125}, std::pair{0.125, -0.375},
                                   std::pair{0.375, 0.125}, std::pair{-0.125, 0.375}}) {
        sum += look(shots[static_cast<std::size_t>(row)], rays.at(column + du, row + dv),
                    0.5 * pixel, nullptr);
      }
      for (int k = 0; k < 3; ++k) image.at(column, row, k) = 0.25F * sum[k];
    }
  });
  return image;
}

}  // namespace nadir::simulation
