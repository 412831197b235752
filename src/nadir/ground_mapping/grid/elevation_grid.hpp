// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace nadir::ground {

/// What is known of a square of the ground. NaN in `height` says "nothing", and nothing else does.
struct Cell {
  float height = std::numeric_limits<float>::quiet_NaN();  ///< metres, odometry frame
  float variance = 0.0F;                                   ///< m^2
  float second_height = 0.0F;                              ///< the rival, where second_views > 0
  float second_variance = 0.0F;
  float red = 0.0F;  ///< sums of weight times colour; grey frames use red alone
  float green = 0.0F;
  float blue = 0.0F;
  float weight = 0.0F;
  float best_weight = 0.0F;       ///< of a single frame
  std::uint32_t seen_ms = 0;      ///< when last measured, since the map began
  std::uint32_t odometer_mm = 0;  ///< where on the way
  std::uint16_t views = 0;        ///< frames that agreed on `height`; 0 = a single point so far
  std::uint16_t second_views = 0;
  std::uint8_t seen_through = 0;  ///< frames since the last agreement whose rays passed below
  std::uint8_t judged = 0;        ///< the last frame (its number's low bits) that had a say in that

  bool known() const { return !std::isnan(height); }
  /// Known, and by more than a single point that might be a false match.
  bool established() const { return views > 0; }
};

/// The index of a cell in the plane of the odometry frame: the square [i, i + 1) x resolution.
struct CellIndex {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

/// A square window of cells that rolls over an unbounded plane. Cells keep their place in memory
/// when the window moves (their index modulo the power-of-two side); only the strips that enter are
/// cleared.
class ElevationGrid {
 public:
  ElevationGrid(double resolution_m, int side);

  double resolution() const { return resolution_; }
  int side() const { return side_; }
  CellIndex origin() const { return origin_; }  ///< of the window's lowest cell

  CellIndex index_of(double x, double y) const {
    return {static_cast<std::int64_t>(std::floor(x / resolution_)),
            static_cast<std::int64_t>(std::floor(y / resolution_))};
  }
  bool contains(CellIndex i) const {
    return i.x >= origin_.x && i.x < origin_.x + side_ && i.y >= origin_.y &&
           i.y < origin_.y + side_;
  }
  /// Place in memory of a cell that the window contains.
  std::uint32_t address(CellIndex i) const {
    return (static_cast<std::uint32_t>(i.x) & mask_) * static_cast<std::uint32_t>(side_) +
           (static_cast<std::uint32_t>(i.y) & mask_);
  }
  Cell& at(std::uint32_t address) { return cells_[address]; }
  const Cell& at(std::uint32_t address) const { return cells_[address]; }
  Cell& at(CellIndex i) { return cells_[address(i)]; }
  const Cell& at(CellIndex i) const { return cells_[address(i)]; }
  /// The cell, or nullptr outside the window.
  const Cell* find(CellIndex i) const { return contains(i) ? &cells_[address(i)] : nullptr; }

  /// Centres the window; forgets what leaves it.
  void centre_on(CellIndex centre);
  void clear();

 private:
  void clear_column(std::int64_t x);
  void clear_row(std::int64_t y);

  double resolution_;
  int side_;
  std::uint32_t mask_;
  CellIndex origin_;
  std::vector<Cell> cells_;
};

}  // namespace nadir::ground
