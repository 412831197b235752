// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/aggregator.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace nadir::ground {
namespace {

// Scales of the fixed-point sums. The largest term, weight 1e4 / m^2 times (100 m)^2, leaves room
// for 8e4 points in a cell; the rounding is far below the noise of a single point.
constexpr double kWeightScale = 1 << 20;
constexpr double kVarianceScale = 1 << 30;
constexpr double kColourScale = 1 << 20;
constexpr double kMaxWeight = 1e4;
/// Neighbouring disparities share their matching window: no more than so many count as independent.
constexpr int kMaxIndependent = 4;

CellMeasurement measurement_of(const CellSums& sums, std::uint32_t address, double height_sigma_m) {
  CellMeasurement cell;
  cell.address = address;
  cell.points = sums.points;
  const auto weight = static_cast<double>(sums.weight);
  const double mean = static_cast<double>(sums.weighted_height) / weight;
  const double square = static_cast<double>(sums.weighted_square) / weight;
  const double spread = std::max(0.0, square - mean * mean);
  const double variance = static_cast<double>(sums.variance) / kVarianceScale / sums.points;
  cell.height = static_cast<float>(mean);
  cell.spread = static_cast<float>(spread);
  cell.variance = static_cast<float>(variance / std::min(sums.points, kMaxIndependent) +
                                     spread / sums.points + height_sigma_m * height_sigma_m);
  if (sums.coloured_points > 0) {
    const auto colour_weight = static_cast<double>(sums.colour_weight);
    cell.colour_weight = static_cast<float>(colour_weight / kColourScale / sums.coloured_points);
    for (std::size_t c = 0; c < 3; ++c) {
      cell.sharpest[c] = static_cast<std::uint8_t>((sums.sharpest >> (16 - 8 * c)) & 0xFFU);
      cell.colour[c] = static_cast<float>(static_cast<double>(sums.colour[c]) / colour_weight);
    }
  }
  return cell;
}

}  // namespace

void CellSums::add(const SurfacePoint& point) {
  const double w = std::min(kMaxWeight, 1.0 / static_cast<double>(point.height_variance));
  const double z = point.z;
  weight += static_cast<std::int64_t>(w * kWeightScale);
  weighted_height += static_cast<std::int64_t>(w * z * kWeightScale);
  weighted_square += static_cast<std::int64_t>(w * z * z * kWeightScale);
  variance +=
      static_cast<std::int64_t>(static_cast<double>(point.height_variance) * kVarianceScale);
  ++points;
  if (point.colour_weight > 0.0F) {
    const auto c =
        static_cast<std::int64_t>(static_cast<double>(point.colour_weight) * kColourScale);
    colour_weight += c;
    for (std::size_t i = 0; i < 3; ++i) colour[i] += c * point.colour[i];
    ++coloured_points;
    // Positive floats order like their bits; equal weights are decided by the colour, not by order.
    const std::uint64_t key =
        (std::uint64_t{std::bit_cast<std::uint32_t>(point.colour_weight)} << 24) |
        (std::uint64_t{point.colour[0]} << 16) | (std::uint64_t{point.colour[1]} << 8) |
        point.colour[2];
    sharpest = std::max(sharpest, key);
  }
}

std::int64_t Aggregator::aggregate(const Measurement& measurement, const ElevationGrid& grid) {
  const std::size_t cells =
      static_cast<std::size_t>(grid.side()) * static_cast<std::size_t>(grid.side());
  if (slot_.size() != cells) {
    slot_.assign(cells, 0);
    frame_.assign(cells, 0);
    this_frame_ = 0;
  }
  ++this_frame_;
  const CellIndex sensor =
      grid.index_of(measurement.sensor_in_odom.x(), measurement.sensor_in_odom.y());
  const double resolution = grid.resolution();
  // Where the sensor stands in its cell; the rest of the arithmetic is near zero wherever it is.
  const double offset_x =
      measurement.sensor_in_odom.x() - static_cast<double>(sensor.x) * resolution;
  const double offset_y =
      measurement.sensor_in_odom.y() - static_cast<double>(sensor.y) * resolution;
  const auto cells_per_band = static_cast<std::uint32_t>(cells / kBands);

  stripes_.resize(measurement.points.size());
  tbb::parallel_for(std::size_t{0}, measurement.points.size(), [&](std::size_t s) {
    StripeIndex& stripe = stripes_[s];
    const std::vector<SurfacePoint>& points = measurement.points[s];
    stripe.outside = 0;
    stripe.address.resize(points.size());
    for (auto& list : stripe.points) list.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double x = std::floor((offset_x + static_cast<double>(points[i].x)) / resolution);
      const double y = std::floor((offset_y + static_cast<double>(points[i].y)) / resolution);
      const CellIndex index{sensor.x + static_cast<std::int64_t>(x),
                            sensor.y + static_cast<std::int64_t>(y)};
      if (!grid.contains(index)) {
        ++stripe.outside;
        continue;
      }
      const std::uint32_t address = grid.address(index);
      stripe.address[i] = address;
      stripe.points[address / cells_per_band].push_back(static_cast<std::uint32_t>(i));
    }
  });
  sums_.resize(kBands);
  bands_.resize(kBands);
  tbb::parallel_for(0, kBands, [&](int band) { sum_band(measurement, band); });
  std::int64_t outside = 0;
  for (const StripeIndex& stripe : stripes_) outside += stripe.outside;
  return outside;
}

void Aggregator::sum_band(const Measurement& measurement, int band) {
  const auto b = static_cast<std::size_t>(band);
  std::vector<CellSums>& sums = sums_[b];
  std::vector<CellMeasurement>& cells = bands_[b];
  sums.clear();
  cells.clear();
  std::vector<std::uint32_t> addresses;
  for (std::size_t s = 0; s < stripes_.size(); ++s) {
    const StripeIndex& stripe = stripes_[s];
    for (const std::uint32_t i : stripe.points[b]) {
      const std::uint32_t address = stripe.address[i];
      if (frame_[address] != this_frame_) {
        frame_[address] = this_frame_;
        slot_[address] = static_cast<std::uint32_t>(sums.size());
        sums.emplace_back();
        addresses.push_back(address);
      }
      sums[slot_[address]].add(measurement.points[s][i]);
    }
  }
  cells.reserve(sums.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    cells.push_back(measurement_of(sums[i], addresses[i], height_sigma_m_));
  }
  // In the order of the cells, whatever the order of the points was.
  std::sort(cells.begin(), cells.end(), [](const CellMeasurement& a, const CellMeasurement& b2) {
    return a.address < b2.address;
  });
}

}  // namespace nadir::ground
