// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "nadir/ground_mapping/depth/points.hpp"
#include "nadir/ground_mapping/grid/elevation_grid.hpp"

namespace nadir::ground {

/// Sums over the points of one frame in one cell. Integers, in fixed point: their sum does not
/// depend on the order of the points, so neither does anything that follows.
struct CellSums {
  std::int64_t weight = 0;  ///< 1 / height variance
  std::int64_t weighted_height = 0;
  std::int64_t weighted_square = 0;
  std::int64_t variance = 0;
  std::int64_t colour_weight = 0;
  std::array<std::int64_t, 3> colour{};
  std::int32_t points = 0;
  std::int32_t coloured_points = 0;
  std::uint64_t sharpest = 0;  ///< colour weight and colour of the sharpest point, packed

  void add(const SurfacePoint& point);
};

/// One frame's measurement of one cell (equation 7).
struct CellMeasurement {
  std::uint32_t address = 0;
  std::int32_t points = 0;
  float height = 0.0F;         ///< metres over the sensor
  float variance = 0.0F;       ///< R_m
  float spread = 0.0F;         ///< S: variance of the points about their mean
  float colour_weight = 0.0F;  ///< mean over the points; 0 = no colour
  std::array<float, 3> colour{};
  std::array<std::uint8_t, 3> sharpest{};  ///< colour of the sharpest single point
  bool accepted = false;  ///< set by the fuser: agreed with the map, or began the cell
};

/// Sorts points into the cells of the grid. Two passes: first each stripe of points finds the cells
/// of its points, then each band of cells sums its points up, so no two threads write to one cell.
class Aggregator {
 public:
  static constexpr int kBands = 32;

  explicit Aggregator(double height_sigma_m) : height_sigma_m_(height_sigma_m) {}

  /// The measured cells, by bands of the grid. Returns how many points lay outside the grid.
  std::int64_t aggregate(const Measurement& measurement, const ElevationGrid& grid);

  std::vector<std::vector<CellMeasurement>>& bands() { return bands_; }
  const std::vector<std::vector<CellMeasurement>>& bands() const { return bands_; }

 private:
  struct StripeIndex {
    std::vector<std::uint32_t> address;  ///< of each point
    std::array<std::vector<std::uint32_t>, kBands> points;
    std::int64_t outside = 0;
  };

  void sum_band(const Measurement& measurement, int band);

  double height_sigma_m_;
  std::vector<StripeIndex> stripes_;
  std::vector<std::uint32_t> slot_;   ///< of each cell, in its band's sums; valid in this frame if
  std::vector<std::uint32_t> frame_;  ///< this says so
  std::uint32_t this_frame_ = 0;
  std::vector<std::vector<CellSums>> sums_;
  std::vector<std::vector<CellMeasurement>> bands_;
};

}  // namespace nadir::ground
