// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/simulated_world.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/simulation/scene/scene.hpp"
#include "nadir/simulation/sensing/tone.hpp"

namespace nadir {
namespace {

using simulation::RayHit;

constexpr double kAbove = 1000.0;  ///< metres: higher than anything that is built

/// Rays of a pixel of an orthomosaic, a side: their mean is its colour.
constexpr int kRaysPerSide = 2;

RayHit look_down(const simulation::Scene& scene, double x, double y) {
  return scene.caster().cast({x, y, kAbove}, {0.0, 0.0, -1.0});
}

}  // namespace

SimulatedWorld SimulatedWorld::make(std::uint64_t seed, const WorldOptions& options) {
  WorldOptions checked = options;
  check(checked);
  return SimulatedWorld(simulation::make_terrain(seed, checked));
}

SimulatedWorld SimulatedWorld::drape(const Orthomosaic& map,
                                     const std::optional<ElevationMap>& surface, std::uint64_t seed,
                                     std::optional<int> utm_zone) {
  return SimulatedWorld(simulation::drape_terrain(seed, map, surface, utm_zone));
}

double SimulatedWorld::width_m() const { return terrain_->options.width_m; }
double SimulatedWorld::depth_m() const { return terrain_->options.depth_m; }
const SiteAnchor& SimulatedWorld::anchor() const { return terrain_->anchor; }

double SimulatedWorld::ground_height(double x, double y) const {
  return terrain_->heights.at(x, y);
}

std::vector<std::vector<Pose2>> SimulatedWorld::routes() const {
  constexpr double kStep = 0.5;
  std::vector<std::vector<Pose2>> routes;
  for (const simulation::Path& path : terrain_->layout.routes) {
    std::vector<Pose2> route;
    const auto count = static_cast<int>(path.length() / kStep) + 1;
    for (int i = 0; i < count; ++i) {
      const simulation::PathPose pose = path.at(i * kStep);
      route.push_back({pose.point.x(), pose.point.y(), wrap_angle(pose.yaw)});
    }
    routes.push_back(std::move(route));
  }
  return routes;
}

bool SimulatedWorld::has_lanes() const { return !terrain_->draped; }

SimulatedScene SimulatedWorld::seen(const Appearance& appearance) const {
  return SimulatedScene(std::make_shared<simulation::Scene>(terrain_, appearance));
}

double SimulatedScene::surface_height(double x, double y) const {
  return kAbove - look_down(*scene_, x, y).t;
}

Orthomosaic SimulatedScene::true_orthomosaic(const GeoReference& geo, int width, int height) const {
  Raster<float> linear(width, height, 0.0F, 3);
  const double pixel = geo.resolution / kRaysPerSide;
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (int i = 0; i < kRaysPerSide * kRaysPerSide; ++i) {
        const int across = i % kRaysPerSide;
        const int downwards = i / kRaysPerSide;
        const double x = geo.x_at(column + (across + 0.5) / kRaysPerSide);
        const double y = geo.y_at(row + (downwards + 0.5) / kRaysPerSide);
        const Eigen::Vector3d origin(x, y, kAbove);
        const Eigen::Vector3d down(0.0, 0.0, -1.0);
        sum += scene_->colour(origin, down, scene_->caster().cast(origin, down), pixel);
      }
      for (int k = 0; k < 3; ++k) {
        linear.at(column, row, k) = sum[k] / (kRaysPerSide * kRaysPerSide);
      }
    }
  });
  return {simulation::display(linear), Raster<std::uint8_t>(width, height, 255), geo};
}

ElevationMap SimulatedScene::true_surface(const GeoReference& geo, int width, int height) const {
  ElevationMap map{Raster<float>(width, height), geo};
  tbb::parallel_for(0, height, [&](int row) {
    for (int column = 0; column < width; ++column) {
      map.height_m.at(column, row) =
          static_cast<float>(surface_height(geo.x_at(column + 0.5), geo.y_at(row + 0.5)));
    }
  });
  return map;
}

bool SimulatedScene::sees(const Point3<frames::Map>& from, const Point3<frames::Map>& to) const {
  const Eigen::Vector3d direction = to.vector() - from.vector();
  return scene_->caster().cast(from.vector(), direction, 0.0, 1.0).solid == RayHit::kSky;
}

void SimulatedScene::refine(std::span<const Pose2> places, double radius_m) {
  scene_->refine(places, radius_m);
}

}  // namespace nadir
