// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/planning.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/core/angle.hpp"

namespace nadir::simulation {
namespace {

constexpr std::uint64_t kPlanStream = 1;
constexpr double kMargin = 22.0;  ///< furnished beyond the site, metres

}  // namespace

Planner::Planner(std::uint64_t seed, double width_m, double depth_m)
    : random_(seed, kPlanStream),
      width_(width_m),
      depth_(depth_m),
      flip_x_(random_.uniform(1U << 20U) < 0.5),
      flip_y_(random_.uniform((1U << 20U) + 1U) < 0.5) {}

Eigen::Vector2d Planner::at(double x, double y) const {
  return {(flip_x_ ? 1.0 - x : x) * width_, (flip_y_ ? 1.0 - y : y) * depth_};
}

Path Planner::path(std::initializer_list<Eigen::Vector2d> corners,
                   std::initializer_list<double> radii, bool endless) {
  const std::vector<Eigen::Vector2d> points(corners);
  const std::vector<double> list(radii);
  return {points, list, endless};
}

void Planner::add_road(Path path, double half_width, RoadKind kind) {
  layout.roads.push_back({std::move(path), half_width, kind, {}});
}

void Planner::add_area(double x, double y, double half_length, double half_width, AreaKind kind) {
  Area area;
  area.centre = at(x, y);
  area.half_length = half_length;
  area.half_width = half_width;
  area.kind = kind;
  area.number = static_cast<std::uint32_t>(layout.areas.size());
  layout.areas.push_back(area);
}

void Planner::try_building(double x, double y, double half_length, double half_width, double height,
                           bool gable) {
  Building building;
  building.plan.centre = at(x, y);
  building.plan.half_length = half_length;
  building.plan.half_width = half_width;
  building.height = height;
  building.gable = gable;
  building.look = static_cast<std::uint32_t>(draw() * 1000.0);
  const Area& plan = building.plan;
  for (int u = -4; u <= 4; ++u) {
    for (int v = -4; v <= 4; ++v) {
      const Eigen::Vector2d local(0.25 * u * half_length, 0.25 * v * half_width);
      if (!is_free(layout, plan.place(local), 1.5)) return;
    }
  }
  layout.buildings.push_back(building);
}

void Planner::add_hedge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool hedge) {
  Barrier barrier;
  const Eigen::Vector2d side = to - from;
  barrier.plan.centre = 0.5 * (from + to);
  barrier.plan.yaw = std::atan2(side.y(), side.x());
  barrier.plan.half_length = 0.5 * side.norm();
  barrier.plan.half_width = hedge ? 0.45 : 0.15;
  barrier.plan.number = static_cast<std::uint32_t>(layout.barriers.size());
  barrier.height = hedge ? draw(0.9, 1.6) : draw(0.7, 1.1);
  barrier.hedge = hedge;
  // Only what is clear of roads and houses stands.
  for (int u = -10; u <= 10; ++u) {
    if (!is_free(layout, barrier.plan.place({0.1 * u * barrier.plan.half_length, 0.0}), 0.3)) {
      return;
    }
  }
  layout.barriers.push_back(barrier);
}

bool Planner::is_furnished(const Eigen::Vector2d& p) const {
  return p.x() > -kMargin && p.y() > -kMargin && p.x() < width_ + kMargin &&
         p.y() < depth_ + kMargin;
}

bool Planner::is_clear_of_others(const Road& road, const Eigen::Vector2d& p,
                                 double clearance) const {
  return std::none_of(layout.roads.begin(), layout.roads.end(), [&](const Road& other) {
    return &other != &road && std::abs(other.path.locate(p).across) < other.half_width + clearance;
  });
}

void Planner::add_street_furniture() {
  for (const Road& road : layout.roads) {
    if (road.kind == RoadKind::kStreet || road.kind == RoadKind::kLane) add_decals(road);
    if (road.kind != RoadKind::kStreet) continue;
    add_arrows(road);
    add_lamps(road);
    add_street_trees(road);
  }
}

void Planner::add_decals(const Road& road) {
  double along = draw(0.0, 6.0);
  while (along < road.path.length()) {
    const double side = draw() < 0.5 ? -1.0 : 1.0;
    const double kind = draw();
    Decal decal;
    decal.kind = DecalKind::kPatch;
    if (kind < 0.25) decal.kind = DecalKind::kManhole;
    if (kind >= 0.25 && kind < 0.45) decal.kind = DecalKind::kDrain;
    double across = draw(0.4, road.half_width - 0.6);
    if (decal.kind == DecalKind::kDrain) {
      across = road.half_width - 0.27;
      decal.half_length = 0.28;
      decal.half_width = 0.22;
    }
    if (decal.kind == DecalKind::kPatch) {
      decal.half_length = 0.4 + 2.4 * std::pow(draw(), 2.0);
      decal.half_width = draw(0.3, 1.1);
      decal.tone = draw() < 0.7 ? static_cast<float>(draw(-0.35, -0.15)) : 0.16F;
    }
    decal.at = road.path.place({along, side * across});
    decal.yaw = road.path.at(along).yaw;
    if (is_furnished(decal.at) && is_clear_of_others(road, decal.at, 1.0)) {
      layout.decals.push_back(decal);
    }
    along += draw(4.0, 9.0);
  }
}

/// Arrows that lead to the crossings.
void Planner::add_arrows(const Road& road) {
  for (const double middle : road.crossings) {
    for (const double side : {-1.0, 1.0}) {
      Decal arrow;
      arrow.kind = DecalKind::kArrow;
      arrow.half_length = 4.2;
      const double along = middle + side * draw(8.5, 10.0);
      arrow.at = road.path.place({along, side * 0.5 * road.half_width});
      arrow.yaw = road.path.at(along).yaw + (side > 0.0 ? kPi : 0.0);
      if (is_clear_of_others(road, arrow.at, 6.0)) layout.decals.push_back(arrow);
    }
  }
}

void Planner::add_lamps(const Road& road) {
  double side = 1.0;
  double along = draw(5.0, 15.0);
  while (along < road.path.length()) {
    side = -side;
    Post post;
    post.at = road.path.place({along, side * (road.half_width + 0.7)});
    post.yaw = road.path.at(along).yaw - side * 0.5 * kPi;
    post.height = 6.0;
    if (is_furnished(post.at) && is_clear_of_others(road, post.at, 2.0)) {
      layout.posts.push_back(post);
    }
    along += draw(20.0, 26.0);
  }
}

void Planner::add_street_trees(const Road& road) {
  double along = draw(2.0, 8.0);
  while (along < road.path.length()) {
    for (const double edge : {-1.0, 1.0}) {
      if (draw() < 0.35) continue;
      Tree tree;
      tree.at =
          road.path.place({along, edge * (road.half_width + kPavementWidth + draw(0.9, 2.2))});
      tree.crown = draw(1.6, 2.9);
      tree.height = tree.crown * draw(2.3, 2.9);
      tree.number = static_cast<std::uint32_t>(layout.trees.size());
      if (is_furnished(tree.at) && is_free(layout, tree.at, 0.6)) layout.trees.push_back(tree);
    }
    along += draw(8.0, 14.0);
  }
}

void Planner::add_trees(int count, double smallest, double largest) {
  for (int i = 0; i < count; ++i) {
    Tree tree;
    tree.at = {draw(-kMargin, width_ + kMargin), draw(-kMargin, depth_ + kMargin)};
    tree.crown = draw(smallest, largest);
    tree.height = tree.crown * draw(2.2, 2.9);
    tree.number = static_cast<std::uint32_t>(layout.trees.size());
    const bool crowded =
        std::any_of(layout.trees.begin(), layout.trees.end(), [&](const Tree& other) {
          return (other.at - tree.at).norm() < 0.8 * (other.crown + tree.crown);
        });
    if (!crowded && is_free(layout, tree.at, 0.7 * tree.crown)) layout.trees.push_back(tree);
  }
}

void Planner::add_parking_stalls(double from_edge) {
  for (const Area& area : layout.areas) {
    if (area.kind != AreaKind::kParking) continue;
    const auto count = static_cast<int>(2.0 * area.half_length / kStallWidth);
    for (int i = 0; i < count; ++i) {
      const double along = -area.half_length + (i + 0.5) * kStallWidth;
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d place =
            area.place({along, side * (area.half_width - 0.5 * kStallDepth - from_edge)});
        const bool blocked =
            std::any_of(layout.roads.begin(), layout.roads.end(), [&](const Road& road) {
              return std::abs(road.path.locate(place).across) < road.half_width + 1.2;
            });
        if (!blocked) layout.stalls.push_back({place, area.yaw + 0.5 * kPi});
      }
    }
  }
}

}  // namespace nadir::simulation
