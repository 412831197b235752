// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/caster.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace nadir::simulation {
namespace {

constexpr double kCell = 2.0;

/// Whether a ray passes a box within (from, to): slabs.
bool passes(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& origin,
            const Eigen::Vector3d& inverse, double from, double to) {
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.min()[axis] - origin[axis]) * inverse[axis];
    const double b = (box.max()[axis] - origin[axis]) * inverse[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to;
}

Eigen::Vector3d inverse_of(const Eigen::Vector3d& direction) {
  Eigen::Vector3d inverse;
  for (int axis = 0; axis < 3; ++axis) {
    const double speed = direction[axis];
    inverse[axis] = 1.0 / (std::abs(speed) < 1e-12 ? std::copysign(1e-12, speed) : speed);
  }
  return inverse;
}

}  // namespace

Caster::Caster(const HeightField& ground, std::vector<Solid> solids, std::uint64_t seed)
    : ground_(ground), solids_(std::move(solids)), noise_(seed) {
  const Eigen::Vector2d size = ground_.high() - ground_.low();
  cells_ = Raster<Cell>(std::max(1, static_cast<int>(std::ceil(size.x() / kCell))),
                        std::max(1, static_cast<int>(std::ceil(size.y() / kCell))));
  for (int row = 0; row < cells_.height(); ++row) {
    for (int column = 0; column < cells_.width(); ++column) {
      const Eigen::Vector2d low = ground_.low() + kCell * Eigen::Vector2d(column, row);
      Cell& cell = cells_.at(column, row);
      cell.ground_top = ground_.top(low, low + Eigen::Vector2d(kCell, kCell)) + 1e-3;
      cell.top = cell.ground_top;
    }
  }
  for (std::size_t i = 0; i < solids_.size(); ++i) {
    const Eigen::AlignedBox3d& box = solids_[i].box;
    const auto index = [&](double position, double low, int count) {
      return std::clamp(static_cast<int>((position - low) / kCell), 0, count - 1);
    };
    const int last_row = index(box.max().y(), ground_.low().y(), cells_.height());
    const int last_column = index(box.max().x(), ground_.low().x(), cells_.width());
    for (int row = index(box.min().y(), ground_.low().y(), cells_.height()); row <= last_row;
         ++row) {
      for (int column = index(box.min().x(), ground_.low().x(), cells_.width());
           column <= last_column; ++column) {
        Cell& cell = cells_.at(column, row);
        cell.solids.push_back(static_cast<std::uint32_t>(i));
        cell.top = std::max(cell.top, box.max().z());
      }
    }
  }
  for (const Cell& cell : cells_.values()) top_ = std::max(top_, cell.top);
}

const Caster::Cell* Caster::cell_at(double x, double y) const {
  const auto column = static_cast<int>(std::floor((x - ground_.low().x()) / kCell));
  const auto row = static_cast<int>(std::floor((y - ground_.low().y()) / kCell));
  return cells_.contains(column, row) ? &cells_.at(column, row) : nullptr;
}

bool Caster::is_bare(double x, double y) const {
  const Cell* cell = cell_at(x, y);
  return cell == nullptr || cell->solids.empty();
}

bool Caster::is_inside(const Eigen::Vector3d& point) const {
  const Cell* cell = cell_at(point.x(), point.y());
  if (cell == nullptr) return false;
  return std::any_of(cell->solids.begin(), cell->solids.end(), [&](std::uint32_t index) {
    const Solid& solid = solids_[index];
    return !solid.faces.empty() &&
           std::all_of(solid.faces.begin(), solid.faces.end(),
                       [&](const Face& face) { return face.normal.dot(point) <= face.offset; });
  });
}

void Movers::add(std::vector<Solid> solids) {
  Thing thing;
  for (const Solid& solid : solids) thing.box.extend(solid.box);
  thing.solids = std::move(solids);
  things.push_back(std::move(thing));
}

void Caster::meet_movers(const Movers& movers, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, double from, RayHit& best) const {
  const Eigen::Vector3d inverse = inverse_of(direction);
  auto index = static_cast<int>(solids_.size());
  for (const Movers::Thing& thing : movers.things) {
    if (passes(thing.box, origin, inverse, from, best.t)) {
      for (std::size_t i = 0; i < thing.solids.size(); ++i) {
        const Solid& solid = thing.solids[i];
        const auto hit = solid.meet(origin, direction, from, best.t, noise_);
        if (hit) {
          best = {hit->t, index + static_cast<int>(i), &solid, hit->normal, hit->material};
        }
      }
    }
    index += static_cast<int>(thing.solids.size());
  }
}

void Caster::meet_solids(const Cell& cell, const Eigen::Vector3d& origin,
                         const Eigen::Vector3d& direction, double from, RayHit& best) const {
  const Eigen::Vector3d inverse = inverse_of(direction);
  for (const std::uint32_t index : cell.solids) {
    const Solid& solid = solids_[index];
    if (!passes(solid.box, origin, inverse, from, best.t)) continue;
    const auto hit = solid.meet(origin, direction, from, best.t, noise_);
    if (hit) best = {hit->t, static_cast<int>(index), &solid, hit->normal, hit->material};
  }
}

/// Visits the cells along a ray in order, each with the parameters of entry and exit, until `visit`
/// says that it is done.
template <class Visit>
void Caster::walk(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from,
                  double to, const Visit& visit) const {
  const Eigen::Vector2d size(cells_.width() * kCell, cells_.height() * kCell);
  const Eigen::Vector3d low(ground_.low().x(), ground_.low().y(), -1e3);
  const Eigen::Vector3d high(low.x() + size.x(), low.y() + size.y(), top_);
  const Eigen::Vector3d inverse = inverse_of(direction);
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (low[axis] - origin[axis]) * inverse[axis];
    const double b = (high[axis] - origin[axis]) * inverse[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from >= to) return;
  const Eigen::Vector3d entry = origin + from * direction;
  std::array<int, 2> at{};
  std::array<int, 2> step{};
  std::array<double, 2> next{};
  std::array<double, 2> stride{};
  const std::array<int, 2> count{cells_.width(), cells_.height()};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    at[axis] = std::clamp(static_cast<int>((entry[i] - low[i]) / kCell), 0, count[axis] - 1);
    step[axis] = inverse[i] > 0.0 ? 1 : -1;
    const double border = low[i] + (at[axis] + (step[axis] > 0 ? 1 : 0)) * kCell;
    next[axis] = (border - origin[i]) * inverse[i];
    stride[axis] = kCell * std::abs(inverse[i]);
  }
  double t = from;
  while (t < to) {
    const std::size_t axis = next[0] < next[1] ? 0 : 1;
    const double exit = std::min(next[axis], to);
    if (visit(cells_.at(at[0], at[1]), t, exit)) return;
    t = exit;
    at[axis] += step[axis];
    if (at[axis] < 0 || at[axis] >= count[axis]) return;
    next[axis] += stride[axis];
  }
}

RayHit Caster::cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from,
                    double to, const Movers* movers) const {
  RayHit best;
  best.t = to;
  if (movers != nullptr) meet_movers(*movers, origin, direction, from, best);
  walk(origin, direction, from, to, [&](const Cell& cell, double enter, double exit) {
    const double lowest = origin.z() + std::min(enter * direction.z(), exit * direction.z());
    if (lowest > cell.top) return false;
    if (!cell.solids.empty()) meet_solids(cell, origin, direction, from, best);
    if (lowest <= cell.ground_top) {
      const double t = ground_.meet(origin, direction, enter, std::min(exit, best.t));
      if (!std::isnan(t)) best = {t, RayHit::kGround, nullptr, Eigen::Vector3d::UnitZ(), {}};
    }
    return best.solid != RayHit::kSky && best.t <= exit;
  });
  if (best.solid == RayHit::kSky && direction.z() < 0.0) {
    const double t = -origin.z() / direction.z();  // the plane around the world
    const Eigen::Vector3d p = origin + t * direction;
    if (t > from && t < to && cell_at(p.x(), p.y()) == nullptr) {
      best = {t, RayHit::kGround, nullptr, Eigen::Vector3d::UnitZ(), {}};
    }
  }
  return best;
}

bool Caster::is_free(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double from,
                     double to) const {
  RayHit best;
  best.t = to;
  walk(origin, direction, from, to, [&](const Cell& cell, double enter, double exit) {
    const double lowest = origin.z() + std::min(enter * direction.z(), exit * direction.z());
    if (lowest <= cell.top && !cell.solids.empty()) {
      meet_solids(cell, origin, direction, from, best);
    }
    return best.solid != RayHit::kSky;
  });
  return best.solid == RayHit::kSky;
}

}  // namespace nadir::simulation
