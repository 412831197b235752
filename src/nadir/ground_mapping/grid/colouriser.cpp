// SPDX-License-Identifier: Apache-2.0
#include "nadir/ground_mapping/grid/colouriser.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nadir/ground_mapping/grid/fuser.hpp"
#include "nadir/ground_mapping/grid/renderer.hpp"

namespace nadir::ground {
namespace {

/// Pixels that a cell must cover before their mean is taken.
constexpr double kPixelsForMean = 2.0;

}  // namespace

bool ViewSampler::hidden(double u, double v, double depth) const {
  const int column = static_cast<int>(u) / view_->depth_step;
  const int row = static_cast<int>(v) / view_->depth_step;
  if (!view_->depth.contains(column, row)) return false;
  const double slack = static_cast<double>(view_->depth_slack_m) +
                       static_cast<double>(view_->depth_sigma_per_m2) * depth * depth;
  return depth > static_cast<double>(view_->depth.at(column, row)) + slack;
}

std::array<float, 3> ViewSampler::bilinear(double u, double v) const {
  const int column = std::min(static_cast<int>(u), view_->image.width() - 2);
  const int row = std::min(static_cast<int>(v), view_->image.height() - 2);
  const auto fu = static_cast<float>(u - column), fv = static_cast<float>(v - row);
  std::array<float, 3> colour{};
  for (int c = 0; c < 3; ++c) {
    const int channel = std::min(c, view_->image.channels() - 1);
    const auto value = [&](int i, int j) {
      return static_cast<float>(view_->image.at(column + i, row + j, channel));
    };
    colour[static_cast<std::size_t>(c)] =
        (1.0F - fv) * ((1.0F - fu) * value(0, 0) + fu * value(1, 0)) +
        fv * ((1.0F - fu) * value(0, 1) + fu * value(1, 1));
  }
  return colour;
}

std::array<float, 3> ViewSampler::mean(double u, double v, double half_u, double half_v) const {
  const auto from = [](double x) { return std::max(0, static_cast<int>(std::ceil(x))); };
  const int u0 = from(u - half_u), v0 = from(v - half_v);
  const int u1 = std::min(view_->image.width() - 1, static_cast<int>(std::floor(u + half_u)));
  const int v1 = std::min(view_->image.height() - 1, static_cast<int>(std::floor(v + half_v)));
  if (u1 < u0 || v1 < v0) return bilinear(u, v);
  std::array<float, 3> sum{};
  for (int row = v0; row <= v1; ++row) {
    for (int column = u0; column <= u1; ++column) {
      for (int c = 0; c < 3; ++c) {
        sum[static_cast<std::size_t>(c)] += static_cast<float>(
            view_->image.at(column, row, std::min(c, view_->image.channels() - 1)));
      }
    }
  }
  const auto count = static_cast<float>((u1 - u0 + 1) * (v1 - v0 + 1));
  for (float& value : sum) value /= count;
  return sum;
}

SampledColour ViewSampler::at(const Point3<frames::Odom>& place, double side_m) const {
  SampledColour result;
  const Eigen::Vector3d p = (camera_from_odom_ * place).vector();
  const auto pixel = view_->model.project(p);
  if (!pixel) return result;
  const double u = pixel->x(), v = pixel->y();
  if (!(u >= 0.0 && v >= 0.0 && u <= view_->image.width() - 1.0 &&
        v <= view_->image.height() - 1.0) ||
      hidden(u, v, p.z())) {
    return result;
  }
  // A square on the ground is as wide as the pixels per metre say, and foreshortened in height.
  const double across = 0.5 * side_m * view_->model.fx / p.z();
  const double drop = std::abs(view_->odom_from_camera.translation.z() - place.z);
  const double along = across * std::min(1.0, drop / p.norm());
  result.colour =
      2.0 * across > kPixelsForMean ? mean(u, v, across, std::max(along, 0.5)) : bilinear(u, v);
  // How far on the ground a pixel reaches: along the ray, where it is longest.
  const double footprint = p.z() / view_->model.fx * p.norm() / std::max(drop, 0.05);
  result.weight = static_cast<float>(1.0 / (footprint * footprint + side_m * side_m));
  if (*std::max_element(result.colour.begin(), result.colour.end()) > kSaturated) {
    result.weight *= kSaturatedWeight;
  }
  return result;
}

double colour_inversely(ElevationGrid& grid, const Measurement& measurement, double max_range_m,
                        const GroundMappingOptions& options) {
  if (measurement.views.empty()) return 1.0;
  const std::vector<ViewSampler> samplers(measurement.views.begin(), measurement.views.end());
  const CellIndex sensor =
      grid.index_of(measurement.sensor_in_odom.x(), measurement.sensor_in_odom.y());
  const int reach = static_cast<int>(std::ceil(max_range_m / grid.resolution()));
  const CellIndex first{std::max(grid.origin().x, sensor.x - reach),
                        std::max(grid.origin().y, sensor.y - reach)};
  const CellIndex last{std::min(grid.origin().x + grid.side(), sensor.x + reach),
                       std::min(grid.origin().y + grid.side(), sensor.y + reach)};
  const auto columns = static_cast<std::size_t>(std::max<std::int64_t>(0, last.x - first.x));
  struct Seen {
    std::uint32_t address;
    SampledColour colour;
  };
  std::vector<std::vector<Seen>> seen(columns);
  tbb::parallel_for(std::size_t{0}, columns, [&](std::size_t i) {
    for (std::int64_t y = first.y; y < last.y; ++y) {
      const CellIndex index{first.x + static_cast<std::int64_t>(i), y};
      const Cell& cell = grid.at(index);
      double height = cell.height;
      if (!cell.established()) {
        const auto filled = filled_height(grid, index, options.fill_cells);
        if (!filled) continue;
        height = *filled;
      }
      const Point3<frames::Odom> centre{(static_cast<double>(index.x) + 0.5) * grid.resolution(),
                                        (static_cast<double>(index.y) + 0.5) * grid.resolution(),
                                        height};
      SampledColour best;
      for (const ViewSampler& sampler : samplers) {
        const SampledColour one = sampler.at(centre, grid.resolution());
        if (one.weight > best.weight) best = one;
      }
      if (best.weight > 0.0F) seen[i].push_back({grid.address(index), best});
    }
  });
  ExposureGain gain;
  for (const auto& column : seen) {
    for (const Seen& s : column) gain.compare(grid.at(s.address), s.colour.colour);
  }
  const double factor = options.equalise_exposure ? gain.value() : 1.0;
  const auto g = static_cast<float>(factor);
  tbb::parallel_for(std::size_t{0}, columns, [&](std::size_t i) {
    for (const Seen& s : seen[i]) {
      blend_colour(grid.at(s.address), ColourRule::kInverse, s.colour.weight,
                   g * s.colour.colour[0], g * s.colour.colour[1], g * s.colour.colour[2]);
    }
  });
  return factor;
}

}  // namespace nadir::ground
