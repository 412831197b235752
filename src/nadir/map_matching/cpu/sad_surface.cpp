// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/sad_surface.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

#include "nadir/core/score_volume.hpp"

namespace nadir::cpu {
namespace {

/// Sums of one row of robot positions.
struct RowSums {
  explicit RowSums(std::size_t width) : difference(width), count(width), seen(width) {}
  std::vector<float> difference;
  std::vector<float> count;
  std::vector<float> seen;
};

/// Adds one template pixel to a whole row of positions: the inner loop runs along the map.
void add_pixel(RowSums& sums, const float* map_value, const float* map_mask, const float* map_valid,
               float local_value, float seen_weight) {
  for (std::size_t x = 0; x < sums.difference.size(); ++x) {
    sums.difference[x] += map_mask[x] * std::abs(map_value[x] - local_value);
    sums.count[x] += map_mask[x];
    sums.seen[x] += map_valid[x] * seen_weight;
  }
}

RowSums sum_row(const Region& region, const RotatedTemplate& local, const PixelWindow& window,
                int position_row) {
  RowSums sums(static_cast<std::size_t>(window.width));
  for (int row = 0; row < local.value.height(); ++row) {
    const int map_row = position_row + local.top - region.place.top + row;
    for (int column = 0; column < local.value.width(); ++column) {
      if (local.mask.at(column, row) == 0.0F) continue;
      const int map_column = local.left - region.place.left + column;
      add_pixel(sums, &region.value.at(map_column, map_row),
                &region.takes_part.at(map_column, map_row), &region.valid.at(map_column, map_row),
                local.value.at(column, row), local.seen.at(column, row));
    }
  }
  return sums;
}

}  // namespace

std::vector<ScoreSurface> sad_surfaces(const MatchingOptions& options, const Region& region,
                                       std::span<const RotatedTemplate> templates,
                                       const PixelWindow& window, const StopToken& stop) {
  std::vector<ScoreSurface> surfaces;
  for (const RotatedTemplate& local : templates) {
    ScoreSurface surface{Raster<float>(window.width, window.height, kUndefinedScore),
                         Raster<float>(window.width, window.height)};
    tbb::parallel_for(0, window.height, [&](int row) {
      stop.check();
      const RowSums sums = sum_row(region, local, window, row);
      for (int column = 0; column < window.width; ++column) {
        const auto x = static_cast<std::size_t>(column);
        const double share = local.total_seen > 0.0 ? sums.seen[x] / local.total_seen : 0.0;
        surface.valid_weight.at(column, row) = static_cast<float>(share);
        if (share < options.min_valid_weight || sums.count[x] == 0.0F) continue;
        surface.score.at(column, row) = -sums.difference[x] / sums.count[x];
      }
    });
    surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

}  // namespace nadir::cpu
