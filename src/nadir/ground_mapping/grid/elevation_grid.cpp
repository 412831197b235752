// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/elevation_grid.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>

namespace nadir::ground {

ElevationGrid::ElevationGrid(double resolution_m, int side)
    : resolution_(resolution_m),
      side_(side),
      mask_(static_cast<std::uint32_t>(side) - 1U),
      cells_(static_cast<std::size_t>(side) * static_cast<std::size_t>(side)) {}

void ElevationGrid::clear() { std::fill(cells_.begin(), cells_.end(), Cell{}); }

void ElevationGrid::clear_column(std::int64_t x) {
  for (std::int64_t y = origin_.y; y < origin_.y + side_; ++y) at(CellIndex{x, y}) = Cell{};
}

void ElevationGrid::clear_row(std::int64_t y) {
  for (std::int64_t x = origin_.x; x < origin_.x + side_; ++x) at(CellIndex{x, y}) = Cell{};
}

void ElevationGrid::centre_on(CellIndex centre) {
  const CellIndex before = origin_;
  origin_ = {centre.x - side_ / 2, centre.y - side_ / 2};
  const std::int64_t dx = origin_.x - before.x;
  const std::int64_t dy = origin_.y - before.y;
  if (std::abs(dx) >= side_ || std::abs(dy) >= side_) {
    clear();
    return;
  }
  // The strips that enter lie where those that leave lay.
  for (std::int64_t i = 0; i < std::abs(dx); ++i) {
    clear_column(dx > 0 ? origin_.x + side_ - 1 - i : origin_.x + i);
  }
  for (std::int64_t i = 0; i < std::abs(dy); ++i) {
    clear_row(dy > 0 ? origin_.y + side_ - 1 - i : origin_.y + i);
  }
}

}  // namespace nadir::ground
