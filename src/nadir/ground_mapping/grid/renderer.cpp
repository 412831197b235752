// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/renderer.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "nadir/core/error.hpp"

namespace nadir::ground {
namespace {

constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

/// What one sample of the grid, or one pixel, shows.
struct Sample {
  float height = kUnknown;
  bool filled = false;
  float weight = 0.0F;  ///< 0 = no colour
  std::array<float, 3> colour{};
};

class Sampler {
 public:
  /// `plane`: what lies higher than `highest` over it is left out; nullptr = all is shown.
  Sampler(const ElevationGrid& grid, int fill_cells, const OdomPose2& robot,
          const GroundPlane* plane, double highest)
      : grid_(grid), fill_cells_(fill_cells), robot_(robot), plane_(plane), highest_(highest) {}

  /// The ground at a place of the odometry frame: measured, where known cells have at least half of
  /// the bilinear weight; else filled, where the gap is small.
  Sample at(double x, double y) const {
    Sample sample = blend(x, y);
    if (!std::isnan(sample.height)) return sample;
    const CellIndex nearest = grid_.index_of(x, y);
    const Cell* cell = grid_.find(nearest);
    if (cell == nullptr || cell->established()) return sample;
    const auto height = filled_height(grid_, nearest, fill_cells_);
    if (!height || stands_out(*height, x, y)) return sample;
    sample.height = *height;
    sample.filled = true;
    set_colour(sample, *cell);
    return sample;
  }

 private:
  bool stands_out(float height, double x, double y) const {
    return plane_ != nullptr &&
           static_cast<double>(height) > plane_->at(x - robot_.x, y - robot_.y) + highest_;
  }

  static void set_colour(Sample& sample, const Cell& cell) {
    if (cell.weight <= 0.0F) return;
    sample.weight = cell.weight;
    sample.colour = {cell.red / cell.weight, cell.green / cell.weight, cell.blue / cell.weight};
  }

  Sample blend(double x, double y) const {
    Sample sample;
    const double u = x / grid_.resolution() - 0.5;
    const double v = y / grid_.resolution() - 0.5;
    const CellIndex low{static_cast<std::int64_t>(std::floor(u)),
                        static_cast<std::int64_t>(std::floor(v))};
    const double fx = u - std::floor(u), fy = v - std::floor(v);
    double height = 0.0, share = 0.0, colour_share = 0.0, weight = 0.0;
    std::array<double, 3> colour{};
    for (int k = 0; k < 4; ++k) {
      const int i = k % 2, j = k / 2;
      const double part = (i == 0 ? 1.0 - fx : fx) * (j == 0 ? 1.0 - fy : fy);
      const Cell* cell = grid_.find({low.x + i, low.y + j});
      if (cell == nullptr || !cell->established() || stands_out(cell->height, x, y)) continue;
      height += part * static_cast<double>(cell->height);
      share += part;
      if (cell->weight <= 0.0F) continue;
      const double scale = part / static_cast<double>(cell->weight);
      colour[0] += scale * static_cast<double>(cell->red);
      colour[1] += scale * static_cast<double>(cell->green);
      colour[2] += scale * static_cast<double>(cell->blue);
      weight += part * static_cast<double>(cell->weight);
      colour_share += part;
    }
    // Half a cell's share may be missing by rounding where a pixel lies between two cells.
    constexpr double kHalf = 0.5 - 1e-6;
    if (share < kHalf) return sample;
    sample.height = static_cast<float>(height / share);
    if (colour_share < kHalf) return sample;
    sample.weight = static_cast<float>(weight / colour_share);
    for (std::size_t c = 0; c < 3; ++c) {
      sample.colour[c] = static_cast<float>(colour[c] / colour_share);
    }
    return sample;
  }

  const ElevationGrid& grid_;
  int fill_cells_;
  OdomPose2 robot_;
  const GroundPlane* plane_;
  double highest_;
};

/// The mean of the samples in one pixel; a pixel shows what at least half of it does.
Sample mean_of(const std::vector<Sample>& samples) {
  if (samples.size() == 1) return samples.front();
  Sample mean;
  double height = 0.0, weight = 0.0;
  std::array<double, 3> colour{};
  std::size_t heights = 0, colours = 0, filled = 0;
  for (const Sample& s : samples) {
    if (!std::isnan(s.height)) {
      height += static_cast<double>(s.height);
      ++heights;
      if (s.filled) ++filled;
    }
    if (s.weight <= 0.0F) continue;
    weight += static_cast<double>(s.weight);
    for (std::size_t c = 0; c < 3; ++c) colour[c] += static_cast<double>(s.colour[c]);
    ++colours;
  }
  if (2 * heights >= samples.size()) {
    mean.height = static_cast<float>(height / static_cast<double>(heights));
    mean.filled = 2 * filled > heights;
  }
  if (2 * colours >= samples.size()) {
    mean.weight = static_cast<float>(weight / static_cast<double>(colours));
    for (std::size_t c = 0; c < 3; ++c) {
      mean.colour[c] = static_cast<float>(colour[c] / static_cast<double>(colours));
    }
  }
  return mean;
}

/// The nearest known cell within `most` gap cells along one axis; its distance in cells, or 0.
int known_along(const ElevationGrid& grid, CellIndex from, std::int64_t dx, std::int64_t dy,
                int most) {
  for (int i = 1; i <= most; ++i) {
    const Cell* cell = grid.find({from.x + dx * i, from.y + dy * i});
    if (cell == nullptr) return 0;
    if (cell->established()) return i;
  }
  return 0;
}

int pixels_of(double size_m, double resolution_m) {
  return std::max(1, static_cast<int>(std::lround(size_m / resolution_m)));
}

void check_fits(const ElevationGrid& grid, const RenderOptions& options) {
  const double reach = grid.side() * grid.resolution();
  if (options.size_x_m <= reach && options.size_y_m <= reach) return;
  throw Error(ErrorKind::kUsage,
              "a local map of " + to_text(options.size_x_m) + " x " + to_text(options.size_y_m) +
                  " m is larger than the grid of " + to_text(reach) + " m",
              {}, "enlarge ground_mapping.grid_cells, or ask for a smaller map");
}

/// An empty map whose pixels are laid out around the robot.
LocalMap frame_of(const ElevationGrid& grid, const OdomPose3& pose, const RenderOptions& options,
                  int channels) {
  const int width = pixels_of(options.size_x_m, options.resolution_m);
  const int height = pixels_of(options.size_y_m, options.resolution_m);
  LocalMap map;
  map.odom_from_robot = pose;
  map.ortho.image = Raster<std::uint8_t>(width, height, 0, channels);
  map.ortho.valid = Raster<std::uint8_t>(width, height, kHole);
  map.ortho.geo.resolution = options.resolution_m;
  map.ortho.geo.west = -0.5 * width * options.resolution_m;
  map.ortho.geo.north = 0.5 * height * options.resolution_m;
  if (options.up == MapUp::kOdom) {
    // Pixels cover whole cells, so that nothing is resampled; the robot stands where it stands.
    const double r = grid.resolution();
    const double x = pose.translation.x(), y = pose.translation.y();
    map.ortho.geo.west = std::round((x + map.ortho.geo.west) / r) * r - x;
    map.ortho.geo.north = std::round((y + map.ortho.geo.north) / r) * r - y;
  }
  map.weight = Raster<float>(width, height, 0.0F);
  map.elevation = {Raster<float>(width, height, kUnknown), map.ortho.geo};
  return map;
}

void put(LocalMap& map, int column, int row, const Sample& sample, double ground) {
  if (!std::isnan(sample.height)) {
    map.elevation.height_m.at(column, row) =
        static_cast<float>(static_cast<double>(sample.height) - ground);
  }
  if (sample.weight <= 0.0F || std::isnan(sample.height)) return;
  map.weight.at(column, row) = sample.weight;
  map.ortho.valid.at(column, row) = sample.filled ? kFilledHeight : kMeasured;
  for (int c = 0; c < map.ortho.image.channels(); ++c) {
    const float value = std::clamp(sample.colour[static_cast<std::size_t>(c)], 0.0F, 255.0F);
    map.ortho.image.at(column, row, c) = static_cast<std::uint8_t>(std::lround(value));
  }
}

constexpr std::size_t kFewestForPlane = 100;
constexpr double kSteepest = 0.3;

struct GroundSample {
  Eigen::Vector3d place;  ///< from the robot, along the axes of the odometry frame; z absolute
  double weight;
};

/// The known cells of the strip that the robot drives along; the nearer, the heavier.
std::vector<GroundSample> strip(const ElevationGrid& grid, const OdomPose2& robot, double reach) {
  constexpr double kHalfWidth = 2.0, kBehind = 4.0, kNear = 3.0;
  const double step = grid.resolution();
  const auto along = static_cast<int>((kBehind + reach) / step);
  const auto across = static_cast<int>(2.0 * kHalfWidth / step);
  std::vector<GroundSample> samples;
  for (int i = 0; i <= along; ++i) {
    for (int j = 0; j <= across; ++j) {
      const double x = i * step - kBehind, y = j * step - kHalfWidth;
      const auto p = robot * Point2<frames::Robot>{x, y};
      const Cell* cell = grid.find(grid.index_of(p.x, p.y));
      if (cell == nullptr || !cell->established()) continue;
      samples.push_back({{p.x - robot.x, p.y - robot.y, static_cast<double>(cell->height)},
                         1.0 / (1.0 + (x * x + y * y) / (kNear * kNear))});
    }
  }
  return samples;
}

/// Least squares, repeated without what lies off the last plane: kerbs, walls, cars.
GroundPlane fit_plane(const std::vector<GroundSample>& samples) {
  std::vector<double> heights;
  for (const GroundSample& s : samples) heights.push_back(s.place.z());
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  GroundPlane plane{*middle, 0.0, 0.0};
  for (const double tolerance : {0.8, 0.3, 0.15}) {
    Eigen::Matrix3d a =
        Eigen::Vector3d(1e-3, 1.0, 1.0).asDiagonal();  // level unless told otherwise
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const GroundSample& s : samples) {
      const double off = s.place.z() - plane.at(s.place.x(), s.place.y());
      if (std::abs(off) > tolerance) continue;
      const Eigen::Vector3d row(1.0, s.place.x(), s.place.y());
      a += s.weight * row * row.transpose();
      b += s.weight * (s.place.z() - *middle) * row;
    }
    const Eigen::Vector3d x = a.ldlt().solve(b);
    plane = {*middle + x[0], std::clamp(x[1], -kSteepest, kSteepest),
             std::clamp(x[2], -kSteepest, kSteepest)};
  }
  return plane;
}

}  // namespace

std::optional<GroundPlane> ground_plane(const ElevationGrid& grid,
                                        const OdomPose3& odom_from_robot) {
  const OdomPose2 robot = planar(odom_from_robot);
  for (const double reach : {6.0, 12.0}) {
    const std::vector<GroundSample> samples = strip(grid, robot, reach);
    if (samples.size() >= kFewestForPlane) return fit_plane(samples);
  }
  return std::nullopt;
}

std::optional<float> filled_height(const ElevationGrid& grid, CellIndex index, int fill_cells) {
  double sum = 0.0, weights = 0.0;
  for (int axis = 0; axis < 2; ++axis) {
    const std::int64_t dx = axis == 0 ? 1 : 0, dy = 1 - dx;
    const int before = known_along(grid, index, -dx, -dy, fill_cells);
    if (before == 0) continue;
    const int after = known_along(grid, index, dx, dy, fill_cells + 1 - before);
    if (after == 0) continue;
    const double a = grid.at(CellIndex{index.x - dx * before, index.y - dy * before}).height;
    const double b = grid.at(CellIndex{index.x + dx * after, index.y + dy * after}).height;
    // The shorter bridge is the safer one.
    const double weight = 1.0 / (before + after);
    sum += weight * (a * after + b * before) / (before + after);
    weights += weight;
  }
  if (weights == 0.0) return std::nullopt;
  return static_cast<float>(sum / weights);
}

LocalMap render(const ElevationGrid& grid, const OdomPose3& odom_from_robot,
                const RenderOptions& options, int channels, int fill_cells) {
  check_fits(grid, options);
  LocalMap map = frame_of(grid, odom_from_robot, options, channels);
  OdomPose2 robot = planar(odom_from_robot);
  const auto plane = ground_plane(grid, odom_from_robot);
  if (plane) map.ground_in_odom_m = plane->height;
  const double ground = map.ground_in_odom_m.value_or(odom_from_robot.translation.z());
  const Sampler sampler(grid, fill_cells, robot, options.ground_only && plane ? &*plane : nullptr,
                        options.ground_only_height_m);
  if (options.up == MapUp::kOdom) robot.yaw = 0.0;
  const int parts =
      std::max(1, static_cast<int>(std::ceil(options.resolution_m / grid.resolution() - 1e-9)));
  tbb::parallel_for(0, map.ortho.height(), [&](int row) {
    std::vector<Sample> samples(static_cast<std::size_t>(parts) * static_cast<std::size_t>(parts));
    for (int column = 0; column < map.ortho.width(); ++column) {
      for (int k = 0; k < parts * parts; ++k) {
        const double u = column + (k % parts + 0.5) / parts;
        const double v = row + (k / parts + 0.5) / parts;  // NOLINT(bugprone-integer-division)
        const auto p = robot * Point2<frames::Robot>{map.ortho.geo.x_at(u), map.ortho.geo.y_at(v)};
        samples[static_cast<std::size_t>(k)] = sampler.at(p.x, p.y);
      }
      put(map, column, row, mean_of(samples), ground);
    }
  });
  const auto& valid = map.ortho.valid.values();
  const auto seen = std::count_if(valid.begin(), valid.end(), [](auto v) { return v != kHole; });
  map.coverage = static_cast<double>(seen) / static_cast<double>(valid.size());
  map.low_coverage = map.coverage < options.low_coverage;
  return map;
}

}  // namespace nadir::ground

namespace nadir {

double coverage_of(const LocalMap& map, double size_m) {
  int seen = 0, all = 0;
  for (int row = 0; row < map.ortho.height(); ++row) {
    for (int column = 0; column < map.ortho.width(); ++column) {
      if (std::abs(map.ortho.geo.x_at(column + 0.5)) > 0.5 * size_m ||
          std::abs(map.ortho.geo.y_at(row + 0.5)) > 0.5 * size_m) {
        continue;
      }
      ++all;
      if (map.ortho.valid.at(column, row) != kHole) ++seen;
    }
  }
  return all == 0 ? 0.0 : static_cast<double>(seen) / all;
}

}  // namespace nadir
