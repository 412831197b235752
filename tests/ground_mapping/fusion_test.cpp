// SPDX-License-Identifier: Apache-2.0
// What becomes of measurements that disagree: noise, things that move, light that changes.

#include <gtest/gtest.h>

#include <cmath>

#include "ground_mapping/scene.hpp"
#include "nadir/core/random.hpp"
#include "nadir/ground_mapping/grid/aggregator.hpp"
#include "nadir/ground_mapping/grid/cleaner.hpp"
#include "nadir/ground_mapping/grid/fuser.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir::test {
namespace {

using ground::Aggregator;
using ground::CellIndex;
using ground::ElevationGrid;
using ground::Fuser;
using ground::Measurement;
using ground::Progress;
using ground::SurfacePoint;

/// A grid and what fills it, without a sensor.
struct Bench {
  explicit Bench(const GroundMappingOptions& o = {})
      : options(o), grid(o.resolution_m, 128), aggregator(o.height_sigma_m), fuser(o) {
    grid.centre_on({0, 0});
  }

  FrameStatistics add(std::vector<SurfacePoint> points, const Eigen::Vector3d& sensor) {
    Measurement measurement;
    measurement.sensor_in_odom = sensor;
    measurement.points = {std::move(points)};
    FrameStatistics statistics;
    aggregator.aggregate(measurement, grid);
    now.milliseconds += 100;
    ++now.frame;
    fuser.fuse_heights(aggregator, grid, sensor, now, 1, statistics);
    fuser.fuse_colours(aggregator, grid, ColourRule::kMean, statistics);
    statistics.cells_cleared = ground::clear_seen_through(aggregator, grid, sensor, now);
    return statistics;
  }

  GroundMappingOptions options;
  ElevationGrid grid;
  Aggregator aggregator;
  Fuser fuser;
  Progress now;
};

/// Equations 1 to 3 with noise of half a pixel in the disparity, alike within blocks of five by
/// five pixels, as the matching correlates it.
TEST(Fusion, ItsVarianceIsHonest) {
  GroundMappingOptions options;
  options.height_sigma_m = 0.001;
  options.min_height_variance_m2 = 1e-8;
  options.height_noise_m2_per_s = 0.0;
  Bench bench(options);
  constexpr double kFocal = 400.0, kBaseline = 0.2, kHeight = 1.2, kSigma = 0.5;
  const RandomStream random(5, 1);
  for (std::uint64_t frame = 0; frame < 10; ++frame) {
    std::vector<SurfacePoint> points;
    for (std::uint64_t row = 0; row < 200; ++row) {
      for (std::uint64_t column = 0; column < 400; ++column) {
        const double v = 60.0 + static_cast<double>(row), u = static_cast<double>(column) - 200.0;
        const double depth = kHeight * kFocal / v;
        const double noise = random.normal((frame * 1000 + row / 5) * 1000 + column / 5);
        const double disparity = kFocal * kBaseline / depth + kSigma * noise;
        const double measured = kFocal * kBaseline / disparity;
        if (measured > 6.0 || measured < 1.0) continue;
        const double sigma_z = measured * measured * kSigma / (kFocal * kBaseline);
        SurfacePoint p;
        p.x = static_cast<float>(measured);
        p.y = static_cast<float>(-measured * u / kFocal);
        p.z = static_cast<float>(-measured * v / kFocal);
        p.height_variance = static_cast<float>(std::pow(v / kFocal * sigma_z, 2));
        points.push_back(p);
      }
    }
    bench.add(points, {0.0, 0.0, kHeight});
  }
  double nees = 0.0;
  int cells = 0, outside = 0;
  for (int x = 20; x < 50; ++x) {
    for (int y = -8; y < 8; ++y) {
      const auto& cell = bench.grid.at(CellIndex{x, y});
      if (cell.views < 5) continue;
      const double e = cell.height;
      nees += e * e / static_cast<double>(cell.variance);
      outside += std::abs(e) > 3.0 * std::sqrt(static_cast<double>(cell.variance)) ? 1 : 0;
      ++cells;
    }
  }
  ASSERT_GT(cells, 300);
  EXPECT_GT(nees / cells, 0.7);
  EXPECT_LT(nees / cells, 1.4);
  EXPECT_LE(outside, cells / 100);
}

/// A square metre of points at a height, of one grey.
std::vector<SurfacePoint> patch(double x, double y, double height_over_sensor, int grey,
                                double size = 1.0) {
  std::vector<SurfacePoint> points;
  for (double i = 0.02; i < size; i += 0.04) {
    for (double j = 0.02; j < size; j += 0.04) {
      SurfacePoint p;
      p.x = static_cast<float>(x + i);
      p.y = static_cast<float>(y + j);
      p.z = static_cast<float>(height_over_sensor);
      p.height_variance = 1e-3F;
      p.colour_weight = 100.0F;
      p.colour = {static_cast<std::uint8_t>(grey), static_cast<std::uint8_t>(grey),
                  static_cast<std::uint8_t>(grey)};
      points.push_back(p);
    }
  }
  return points;
}

TEST(Fusion, ABoxThatLeftIsGoneWithinFiveFrames) {
  Bench bench;
  const Eigen::Vector3d sensor(0.0, 0.0, 1.5);
  for (int i = 0; i < 20; ++i) bench.add(patch(3.0, 0.0, -0.5, 255), sensor);
  EXPECT_NEAR(bench.grid.at(CellIndex{35, 5}).height, 1.0F, 1e-3F);
  int replaced = 0;
  for (int i = 0; i < 5; ++i)
    replaced += bench.add(patch(3.0, 0.0, -1.5, 40), sensor).cells_replaced;
  EXPECT_EQ(replaced, 100);
  const auto& cell = bench.grid.at(CellIndex{35, 5});
  EXPECT_NEAR(cell.height, 0.0F, 1e-3F);
  EXPECT_NEAR(cell.red / cell.weight, 40.0F, 0.01F) << "the colour of the box is still there";
}

TEST(Fusion, WhatIsSeenThroughIsForgotten) {
  Bench bench;
  const Eigen::Vector3d sensor(0.0, 0.5, 1.5);
  bench.add(patch(3.0, 0.0, -0.5, 255), sensor);
  // Nothing of the box's own place is measured again: only ground far behind it, along rays that
  // pass below its top.
  int cleared = 0;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(cleared, 0) << i;
    cleared += bench.add(patch(4.5, -0.5, -1.5, 40, 1.6), sensor).cells_cleared;
  }
  EXPECT_GT(cleared, 80);
  EXPECT_FALSE(bench.grid.at(CellIndex{35, 5}).known());
  EXPECT_EQ(bench.grid.at(CellIndex{35, 5}).weight, 0.0F);
}

TEST(Fusion, GroundInFrontOfGroundIsNotSeenThrough) {
  Bench bench;
  const Eigen::Vector3d sensor(0.0, 0.5, 1.5);
  bench.add(patch(3.0, 0.0, -1.45, 100), sensor);  // 5 cm high
  int cleared = 0;
  for (int i = 0; i < 10; ++i) {
    cleared += bench.add(patch(4.2, -0.5, -1.5, 40, 1.6), sensor).cells_cleared;
  }
  EXPECT_EQ(cleared, 0);
}

TEST(Fusion, AFalseHeightDoesNotTouchTheMap) {
  Bench bench;
  const Eigen::Vector3d sensor(0.0, 0.0, 1.5);
  for (int i = 0; i < 4; ++i) bench.add(patch(3.0, 0.0, -1.5, 90), sensor);
  const FrameStatistics s = bench.add(patch(3.0, 0.0, -0.6, 255), sensor);
  EXPECT_EQ(s.cells_rejected, 100);
  EXPECT_EQ(s.dropped.gate, 625);
  EXPECT_NEAR(s.innovation_median_m, 0.9, 1e-3);
  const auto& cell = bench.grid.at(CellIndex{35, 5});
  EXPECT_NEAR(cell.height, 0.0F, 1e-3F);
  EXPECT_NEAR(cell.red / cell.weight, 90.0F, 0.01F);
}

TEST(Fusion, TheExposureIsFittedToTheMap) {
  Bench bench;
  const Eigen::Vector3d sensor(0.0, 0.0, 1.5);
  bench.add(patch(2.0, -1.0, -1.5, 100, 2.0), sensor);
  const FrameStatistics s = bench.add(patch(2.0, -1.0, -1.5, 120, 2.0), sensor);
  EXPECT_NEAR(s.exposure_gain, 100.0 / 120.0, 1e-5);
  const FrameStatistics far_off = bench.add(patch(2.0, -1.0, -1.5, 20, 2.0), sensor);
  EXPECT_EQ(far_off.exposure_gain, 1.25) << "the gain is limited";
}

TEST(Fusion, SharperViewsWeighMore) {
  ground::Cell cell;
  ground::blend_colour(cell, ColourRule::kMean, 1.0F, 100.0F, 100.0F, 100.0F);
  ground::blend_colour(cell, ColourRule::kMean, 3.0F, 200.0F, 200.0F, 200.0F);
  EXPECT_FLOAT_EQ(cell.red / cell.weight, 175.0F);
  ground::blend_colour(cell, ColourRule::kNearest, 2.0F, 0.0F, 0.0F, 0.0F);
  EXPECT_FLOAT_EQ(cell.red / cell.weight, 175.0F) << "a blurrer view does not win";
  ground::blend_colour(cell, ColourRule::kNearest, 4.0F, 10.0F, 10.0F, 10.0F);
  EXPECT_FLOAT_EQ(cell.red / cell.weight, 10.0F);
  for (int i = 0; i < 100; ++i) {
    ground::blend_colour(cell, ColourRule::kMean, 4.0F, 10.0F, 10.0F, 10.0F);
  }
  EXPECT_FLOAT_EQ(cell.weight, 80.0F) << "the past weighs at most twenty best views";
}

}  // namespace
}  // namespace nadir::test
