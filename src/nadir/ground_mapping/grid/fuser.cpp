// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/fuser.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "nadir/core/angle.hpp"

namespace nadir::ground {
namespace {

/// A height that was confirmed in more frames is not the harder to replace.
constexpr std::uint16_t kMostViews = 8;
/// Frames that a rival needs at least.
constexpr std::uint16_t kRivalViews = 3;
/// New light wins slowly: the weight of the past is at most that of so many best views.
constexpr float kMemory = 20.0F;
constexpr double kLowestGain = 0.8;
constexpr double kHighestGain = 1.25;
/// Cells that the map and the frame must share before their exposures are compared.
constexpr std::size_t kOverlapForGain = 200;
/// Ratios of darker grey values are mostly noise.
constexpr float kDarkest = 5.0F;

struct BandResult {
  int created = 0;
  int updated = 0;
  int rejected = 0;
  int replaced = 0;
  std::int64_t sparse_points = 0;
  std::int64_t gated_points = 0;
  std::vector<float> innovations;
};

/// The state that the update of one frame shares.
struct Update {
  const GroundMappingOptions& options;
  const ElevationGrid& grid;
  Eigen::Vector3d sensor;
  Progress now;
  int min_points;

  /// Equation 8: what time and the odometry's drift since the last view add to the variance.
  double predicted_growth(const Cell& cell, double distance_squared) const {
    const double seconds = 1e-3 * (now.milliseconds - cell.seen_ms);
    const double metres = 1e-3 * (now.odometer_mm - cell.odometer_mm);
    const double attitude = radians(options.attitude_drift_deg);
    return options.height_noise_m2_per_s * seconds +
           metres * (options.height_drift_m2_per_m + distance_squared * attitude * attitude);
  }

  bool agrees(double difference, double variance, const CellMeasurement& m) const {
    const double expected =
        variance + static_cast<double>(m.variance) + static_cast<double>(m.spread);
    return difference * difference <= options.gate_sigma * options.gate_sigma * expected;
  }

  /// Equation 9.
  void kalman(float& height, float& variance, double measured, double measured_variance) const {
    const double p = variance;
    const double gain = p / (p + measured_variance);
    height = static_cast<float>(height + gain * (measured - height));
    variance = static_cast<float>(std::max((1.0 - gain) * p, options.min_height_variance_m2));
  }

  void begin(Cell& cell, double measured, const CellMeasurement& m) const {
    cell = Cell{};
    cell.height = static_cast<float>(measured);
    cell.variance =
        std::max(m.variance + m.spread, static_cast<float>(options.min_height_variance_m2));
    cell.views = m.points < min_points ? 0 : 1;
  }

  void take(Cell& cell, CellMeasurement& m, double distance_squared, BandResult& result) const;
  void oppose(Cell& cell, double measured, CellMeasurement& m, BandResult& result) const;
};

void Update::oppose(Cell& cell, double measured, CellMeasurement& m, BandResult& result) const {
  ++result.rejected;
  result.gated_points += m.points;
  if (cell.second_views > 0 &&
      agrees(measured - static_cast<double>(cell.second_height), cell.second_variance, m)) {
    kalman(cell.second_height, cell.second_variance, measured, m.variance);
    ++cell.second_views;
  } else {
    cell.second_height = static_cast<float>(measured);
    cell.second_variance = m.variance + m.spread;
    cell.second_views = 1;
  }
  if (cell.second_views >= kRivalViews && 2 * cell.second_views > cell.views) {
    promote_second(cell);
    ++result.replaced;
    m.accepted = true;
  }
}

void Update::take(Cell& cell, CellMeasurement& m, double distance_squared,
                  BandResult& result) const {
  const double measured = sensor.z() + static_cast<double>(m.height);
  const double growth = cell.known() ? predicted_growth(cell, distance_squared) : 0.0;
  const double innovation = measured - static_cast<double>(cell.height);
  const bool agreed =
      cell.known() && agrees(innovation, static_cast<double>(cell.variance) + growth, m);
  if (!cell.established() && !agreed) {  // nothing is lost by beginning anew
    if (m.points < min_points) result.sparse_points += m.points;
    begin(cell, measured, m);
    cell.judged = now.frame;
    ++result.created;
    m.accepted = true;
  } else {
    cell.variance = static_cast<float>(cell.variance + growth);
    cell.second_variance = static_cast<float>(cell.second_variance + growth);
    result.innovations.push_back(static_cast<float>(std::abs(innovation)));
    if (agreed) {
      kalman(cell.height, cell.variance, measured, m.variance);
      cell.views = std::min<std::uint16_t>(static_cast<std::uint16_t>(cell.views + 1), kMostViews);
      if (cell.second_views > 0) --cell.second_views;
      cell.seen_through = 0;
      cell.judged = now.frame;
      ++result.updated;
      m.accepted = true;
    } else {
      oppose(cell, measured, m, result);
    }
  }
  cell.seen_ms = now.milliseconds;
  cell.odometer_mm = now.odometer_mm;
}

/// The value below which the share `q` of the values lies; NaN where there are none. Reorders.
double quantile(std::vector<float>& values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto position = static_cast<std::ptrdiff_t>(q * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + position, values.end());
  return values[static_cast<std::size_t>(position)];
}

float grey(float red, float green, float blue) {
  return 0.299F * red + 0.587F * green + 0.114F * blue;
}

}  // namespace

void ExposureGain::compare(const Cell& cell, const std::array<float, 3>& colour) {
  if (cell.weight <= 0.0F) return;
  const float before = grey(cell.red, cell.green, cell.blue) / cell.weight;
  const float now = grey(colour[0], colour[1], colour[2]);
  if (before > kDarkest && now > kDarkest) log_ratios_.push_back(std::log(before / now));
}

double ExposureGain::value() {
  if (log_ratios_.size() < kOverlapForGain) return 1.0;
  return std::clamp(std::exp(quantile(log_ratios_, 0.5)), kLowestGain, kHighestGain);
}

void promote_second(Cell& cell) {
  const Cell before = cell;
  cell = Cell{};
  if (before.second_views == 0) return;
  cell.height = before.second_height;
  cell.variance = before.second_variance;
  cell.views = before.second_views;
  cell.seen_ms = before.seen_ms;
  cell.odometer_mm = before.odometer_mm;
}

void blend_colour(Cell& cell, ColourRule rule, float weight, float red, float green, float blue) {
  const bool replaces = rule == ColourRule::kOverwrite ||
                        (rule == ColourRule::kNearest && weight >= cell.best_weight);
  if (replaces) {
    cell.red = cell.green = cell.blue = cell.weight = 0.0F;
  } else if (rule == ColourRule::kNearest) {
    return;
  }
  cell.red += weight * red;
  cell.green += weight * green;
  cell.blue += weight * blue;
  cell.weight += weight;
  cell.best_weight = std::max(cell.best_weight, weight);
  const float most = kMemory * cell.best_weight;
  if (cell.weight > most) {
    const float scale = most / cell.weight;
    cell.red *= scale;
    cell.green *= scale;
    cell.blue *= scale;
    cell.weight = most;
  }
}

void Fuser::fuse_heights(Aggregator& cells, ElevationGrid& grid,
                         const Eigen::Vector3d& sensor_in_odom, Progress now, int min_points,
                         FrameStatistics& statistics) const {
  const Update update{options_, grid, sensor_in_odom, now, min_points};
  std::vector<BandResult> results(cells.bands().size());
  const CellIndex sensor = grid.index_of(sensor_in_odom.x(), sensor_in_odom.y());
  const auto side = static_cast<std::uint32_t>(grid.side());
  tbb::parallel_for(std::size_t{0}, results.size(), [&](std::size_t band) {
    for (CellMeasurement& m : cells.bands()[band]) {
      // Distances wrap with the addresses: the difference modulo the side, about zero.
      const auto wrapped = [side](std::uint32_t a, std::int64_t b) {
        const std::uint32_t d = (a - static_cast<std::uint32_t>(b)) & (side - 1U);
        return d < side / 2 ? static_cast<double>(d) : static_cast<double>(d) - side;
      };
      const double dx = grid.resolution() * wrapped(m.address / side, sensor.x);
      const double dy = grid.resolution() * wrapped(m.address % side, sensor.y);
      update.take(grid.at(m.address), m, dx * dx + dy * dy, results[band]);
    }
  });
  std::vector<float> innovations;
  for (const BandResult& result : results) {
    statistics.cells_new += result.created;
    statistics.cells_updated += result.updated;
    statistics.cells_rejected += result.rejected;
    statistics.cells_replaced += result.replaced;
    statistics.dropped.sparse += result.sparse_points;
    statistics.dropped.gate += result.gated_points;
    innovations.insert(innovations.end(), result.innovations.begin(), result.innovations.end());
  }
  statistics.innovation_median_m = quantile(innovations, 0.5);
  statistics.innovation_p90_m = quantile(innovations, 0.9);
}

void Fuser::fuse_colours(const Aggregator& cells, ElevationGrid& grid, ColourRule rule,
                         FrameStatistics& statistics) const {
  if (options_.equalise_exposure) {
    ExposureGain gain;
    for (const auto& band : cells.bands()) {
      for (const CellMeasurement& m : band) {
        if (m.accepted && m.colour_weight > 0.0F) gain.compare(grid.at(m.address), m.colour);
      }
    }
    statistics.exposure_gain = gain.value();
  }
  const auto gain = static_cast<float>(statistics.exposure_gain);
  tbb::parallel_for(std::size_t{0}, cells.bands().size(), [&](std::size_t band) {
    for (const CellMeasurement& m : cells.bands()[band]) {
      if (!m.accepted || m.colour_weight <= 0.0F) continue;
      std::array<float, 3> colour = m.colour;
      if (rule == ColourRule::kOverwrite) {
        for (std::size_t c = 0; c < 3; ++c) colour[c] = m.sharpest[c];
      }
      blend_colour(grid.at(m.address), rule, m.colour_weight, gain * colour[0], gain * colour[1],
                   gain * colour[2]);
    }
  });
}

}  // namespace nadir::ground
