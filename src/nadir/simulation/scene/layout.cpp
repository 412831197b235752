// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/layout.hpp"

#include <algorithm>
#include <cmath>

namespace nadir::simulation {

Eigen::Vector2d Area::local(const Eigen::Vector2d& point) const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const Eigen::Vector2d offset = point - centre;
  return {c * offset.x() + s * offset.y(), -s * offset.x() + c * offset.y()};
}

Eigen::Vector2d Area::place(const Eigen::Vector2d& local) const {
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return centre + Eigen::Vector2d(c * local.x() - s * local.y(), s * local.x() + c * local.y());
}

double Area::outside(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d p = local(point);
  const double u = std::abs(p.x()) - half_length;
  const double v = std::abs(p.y()) - half_width;
  return std::min(std::max(u, v), 0.0) + std::hypot(std::max(u, 0.0), std::max(v, 0.0));
}

double rounded_union(double a, double b, double radius) {
  const double u = std::max(radius - a, 0.0);
  const double v = std::max(radius - b, 0.0);
  return std::max(radius, std::min(a, b)) - std::hypot(u, v);
}

bool is_free(const Layout& layout, const Eigen::Vector2d& point, double clearance) {
  for (const Road& road : layout.roads) {
    const double verge = road.kind == RoadKind::kStreet ? kPavementWidth : 0.0;
    if (std::abs(road.path.locate(point).across) < road.half_width + verge + clearance)
      return false;
  }
  const auto too_near = [&](const Area& area) { return area.outside(point) < clearance; };
  return std::none_of(layout.areas.begin(), layout.areas.end(), too_near) &&
         std::none_of(layout.buildings.begin(), layout.buildings.end(),
                      [&](const Building& building) { return too_near(building.plan); }) &&
         std::none_of(layout.barriers.begin(), layout.barriers.end(),
                      [&](const Barrier& barrier) { return too_near(barrier.plan); });
}

}  // namespace nadir::simulation
