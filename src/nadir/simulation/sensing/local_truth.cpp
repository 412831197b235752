// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/sensing/local_truth.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/simulation/sensing/tone.hpp"

namespace nadir::simulation {
namespace {

constexpr int kRaysPerSide = 2;

/// Whether the left camera sees a place from one of the poses.
bool is_seen(const Scene& scene, const Eigen::Vector3d& place, const StereoRig& rig, double range,
             const std::vector<Transform3<frames::Map, frames::Robot>>& seen_from) {
  return std::any_of(seen_from.begin(), seen_from.end(), [&](const auto& robot) {
    const auto eye = robot * rig.robot_from_left;
    const Eigen::Vector3d in_camera = eye.rotation.conjugate() * (place - eye.translation);
    if (in_camera.z() < 0.3 || in_camera.norm() > range) return false;
    const auto pixel = rig.left.project(in_camera);
    if (!pixel || pixel->x() < 0.0 || pixel->y() < 0.0 || pixel->x() > rig.left.width - 1 ||
        pixel->y() > rig.left.height - 1) {
      return false;
    }
    const Eigen::Vector3d direction = place - eye.translation;
    return scene.caster().cast(eye.translation, direction, 0.0, 0.995).solid == RayHit::kSky;
  });
}

}  // namespace

LocalTruth local_truth(const Scene& scene, const Transform3<frames::Map, frames::Robot>& robot,
                       const LocalTruthOptions& options, const StereoRig& rig,
                       const std::vector<Transform3<frames::Map, frames::Robot>>& seen_from) {
  const int side =
      std::max(1, static_cast<int>(std::lround(options.size_m / options.resolution_m)));
  const double half = 0.5 * side * options.resolution_m;
  const GeoReference geo{-half, half, options.resolution_m, {}};
  const Pose2 pose = planar(robot);
  const double floor = robot.translation.z();
  const double ceiling = floor + options.ceiling_m;
  const double pixel = options.resolution_m / kRaysPerSide;
  const Eigen::Vector3d down(0.0, 0.0, -1.0);
  Raster<float> linear(side, side, 0.0F, 3);
  LocalTruth truth{{{}, Raster<std::uint8_t>(side, side, 255), geo},
                   {Raster<float>(side, side), geo}};
  tbb::parallel_for(0, side, [&](int row) {
    for (int column = 0; column < side; ++column) {
      const auto above = [&](double u, double v) {
        const auto p = pose * Point2<frames::Robot>{geo.x_at(u), geo.y_at(v)};
        return Eigen::Vector3d(p.x, p.y, ceiling);
      };
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int i = 0; i < kRaysPerSide * kRaysPerSide; ++i) {
        const int across = i % kRaysPerSide;
        const int downwards = i / kRaysPerSide;
        const Eigen::Vector3d origin =
            above(column + (across + 0.5) / kRaysPerSide, row + (downwards + 0.5) / kRaysPerSide);
        sum += scene.colour(origin, down, scene.caster().cast(origin, down), pixel);
      }
      for (int k = 0; k < 3; ++k) {
        linear.at(column, row, k) = sum[k] / (kRaysPerSide * kRaysPerSide);
      }
      const Eigen::Vector3d origin = above(column + 0.5, row + 0.5);
      const Eigen::Vector3d place = origin + scene.caster().cast(origin, down).t * down;
      truth.elevation.height_m.at(column, row) = static_cast<float>(place.z() - floor);
      const bool open =
          !scene.caster().is_inside(origin) &&
          (seen_from.empty() || is_seen(scene, place, rig, options.range_m, seen_from));
      if (open) continue;
      truth.local.valid.at(column, row) = 0;
      truth.elevation.height_m.at(column, row) = std::numeric_limits<float>::quiet_NaN();
    }
  });
  truth.local.image = display(linear);
  return truth;
}

}  // namespace nadir::simulation
