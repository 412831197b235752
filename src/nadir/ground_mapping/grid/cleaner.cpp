// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/cleaner.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nadir/core/angle.hpp"

namespace nadir::ground {
namespace {

/// Rays are gathered by direction, so finely that at 20 m no cell lies between two of them.
constexpr int kSectors = 1440;
/// Frames that must have seen through a cell.
constexpr int kViolations = 3;
/// What is seen must lie so far behind the cell, metres: a cell does not testify against itself.
constexpr double kSurelyBehind = 0.3;
/// How far below the cell's height, beside three standard deviations, metres.
constexpr double kMargin = 0.05;

/// Of one direction: the steepest line of sight to ground at or beyond each step of distance, as
/// height over distance.
struct Rays {
  std::vector<float> steepest;  ///< by distance in cells; kSectors rows of `reach`
  std::vector<int> farthest;    ///< of each sector; -1 = nothing seen
  int reach = 0;
};

int sector_of(double x, double y) {
  const double turn = std::atan2(y, x) / (2.0 * kPi) + 0.5;
  return std::min(kSectors - 1, static_cast<int>(turn * kSectors));
}

struct Viewpoint {
  Eigen::Vector3d position;

  /// From the viewpoint to the centre of a cell, metres.
  Eigen::Vector2d to(CellIndex i, double resolution) const {
    return {(static_cast<double>(i.x) + 0.5) * resolution - position.x(),
            (static_cast<double>(i.y) + 0.5) * resolution - position.y()};
  }
};

/// The cell of the window that lies at an address.
CellIndex index_at(const ElevationGrid& grid, std::uint32_t address) {
  const auto side = static_cast<std::uint32_t>(grid.side());
  const auto place = [side](std::uint32_t wrapped, std::int64_t first) {
    return first + ((wrapped - static_cast<std::uint32_t>(first)) & (side - 1U));
  };
  return {place(address / side, grid.origin().x), place(address % side, grid.origin().y)};
}

Rays gather(const Aggregator& cells, const ElevationGrid& grid, const Viewpoint& viewpoint) {
  Rays rays;
  rays.reach = grid.side();  // a window's half diagonal is shorter
  rays.farthest.assign(kSectors, -1);
  rays.steepest.assign(static_cast<std::size_t>(kSectors) * static_cast<std::size_t>(rays.reach),
                       std::numeric_limits<float>::infinity());
  for (const auto& band : cells.bands()) {
    for (const CellMeasurement& m : band) {
      if (!m.accepted) continue;
      const Eigen::Vector2d away = viewpoint.to(index_at(grid, m.address), grid.resolution());
      const double distance = away.norm();
      const auto step = static_cast<int>(distance / grid.resolution());
      if (step < 1 || step >= rays.reach) continue;
      const int sector = sector_of(away.x(), away.y());
      const double slope =
          (static_cast<double>(grid.at(m.address).height) - viewpoint.position.z()) / distance;
      const int ray = sector * rays.reach + step;
      float& kept = rays.steepest[static_cast<std::size_t>(ray)];
      kept = std::min(kept, static_cast<float>(slope));
      auto& farthest = rays.farthest[static_cast<std::size_t>(sector)];
      farthest = std::max(farthest, step);
    }
  }
  return rays;
}

/// Whether the cell stands in the way of the ray of this slope.
bool stands_in(const Cell& cell, double height_of_ray) {
  return height_of_ray + kMargin <
         static_cast<double>(cell.height) - 3.0 * std::sqrt(static_cast<double>(cell.variance));
}

}  // namespace

int clear_seen_through(const Aggregator& cells, ElevationGrid& grid,
                       const Eigen::Vector3d& sensor_in_odom, Progress now) {
  const Viewpoint viewpoint{sensor_in_odom};
  const Rays rays = gather(cells, grid, viewpoint);
  const double resolution = grid.resolution();
  const int behind = static_cast<int>(std::ceil(kSurelyBehind / resolution));
  int cleared = 0;
  for (int sector = 0; sector < kSectors; ++sector) {
    const int farthest = rays.farthest[static_cast<std::size_t>(sector)];
    const double angle = ((sector + 0.5) / kSectors - 0.5) * 2.0 * kPi;
    const double c = std::cos(angle), s = std::sin(angle);
    float slope = std::numeric_limits<float>::infinity();
    CellIndex previous{std::numeric_limits<std::int64_t>::min(), 0};
    for (int step = farthest - behind; step >= 1; --step) {
      const int ray = sector * rays.reach + step + behind;
      slope = std::min(slope, rays.steepest[static_cast<std::size_t>(ray)]);
      const double distance = (step + 0.5) * resolution;
      const CellIndex index =
          grid.index_of(sensor_in_odom.x() + c * distance, sensor_in_odom.y() + s * distance);
      if (!grid.contains(index) || (index.x == previous.x && index.y == previous.y)) continue;
      previous = index;
      Cell& cell = grid.at(index);
      if (!cell.known() || cell.judged == now.frame ||
          !stands_in(cell, viewpoint.position.z() + static_cast<double>(slope) * distance)) {
        continue;
      }
      cell.judged = now.frame;
      if (++cell.seen_through >= kViolations) {
        promote_second(cell);
        ++cleared;
      }
    }
  }
  return cleared;
}

}  // namespace nadir::ground
