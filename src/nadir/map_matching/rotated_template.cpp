// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/rotated_template.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace nadir {
namespace {

struct Sample {
  double value = 0.0;
  bool seen = false;
};

/// Bilinear over the seen neighbours; seen where they carry at least half of the weight.
Sample sample_seen(const ChannelImage& image, PixelCoordinate at) {
  const double column = at.column - 0.5;
  const double row = at.row - 0.5;
  const int left = static_cast<int>(std::floor(column));
  const int top = static_cast<int>(std::floor(row));
  const double right_share = column - left;
  const double bottom_share = row - top;
  double sum = 0.0;
  double weight = 0.0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      if (!image.value.contains(left + i, top + j)) continue;
      if (image.valid.at(left + i, top + j) == 0) continue;
      const double share =
          (i == 0 ? 1.0 - right_share : right_share) * (j == 0 ? 1.0 - bottom_share : bottom_share);
      sum += share * image.value.at(left + i, top + j);
      weight += share;
    }
  }
  if (weight < 0.5) return {};
  return {sum / weight, true};
}

/// The corners of an image in its own frame, turned by yaw: the extent of the rotated template.
struct Extent {
  double min_x = 0.0, max_x = 0.0, min_y = 0.0, max_y = 0.0;
};
Extent rotated_extent(const ChannelImage& local, double cosine, double sine) {
  Extent extent;
  bool first = true;
  for (const double column : {0.0, static_cast<double>(local.value.width())}) {
    for (const double row : {0.0, static_cast<double>(local.value.height())}) {
      const double x = local.geo.x_at(column);
      const double y = local.geo.y_at(row);
      const double turned_x = cosine * x - sine * y;
      const double turned_y = sine * x + cosine * y;
      if (first) extent = {turned_x, turned_x, turned_y, turned_y};
      first = false;
      extent.min_x = std::min(extent.min_x, turned_x);
      extent.max_x = std::max(extent.max_x, turned_x);
      extent.min_y = std::min(extent.min_y, turned_y);
      extent.max_y = std::max(extent.max_y, turned_y);
    }
  }
  return extent;
}

}  // namespace

PixelRole pixel_role(const MatchingOptions& options) {
  switch (options.score) {
    case Score::kSsd:
    case Score::kSad:
      return {.weighted = false, .whole_square = options.holes == HoleTreatment::kWhite};
    case Score::kWnccPaper:
      return {.weighted = true, .whole_square = true, .weight = options.paper_weight};
    case Score::kWncc:
      return {.weighted = true};
    case Score::kZwncc:
      return {.weighted = true, .weighted_norms = true};
    case Score::kNcc:
    case Score::kZncc:
      break;
  }
  return {};
}

double pixel_weight(PaperWeight kind, PixelCoordinate at, int width, int height) {
  const double half_width = width / 2.0;
  const double half_height = height / 2.0;
  const double across = std::abs(half_width - at.column);
  const double down = std::abs(half_height - at.row);
  if (kind == PaperWeight::kLiteral) return std::abs(2.0 - across * down);
  return 2.0 - (across / half_width) * (down / half_height);
}

RotatedTemplate rotate_template(const ChannelImage& local, double yaw_rad, double map_resolution,
                                const PixelRole& role) {
  const double cosine = std::cos(yaw_rad);
  const double sine = std::sin(yaw_rad);
  const Extent extent = rotated_extent(local, cosine, sine);

  RotatedTemplate turned;
  turned.left = static_cast<int>(std::ceil(extent.min_x / map_resolution - 1e-9));
  turned.top = static_cast<int>(std::ceil(-extent.max_y / map_resolution - 1e-9));
  const int right = static_cast<int>(std::floor(extent.max_x / map_resolution + 1e-9));
  const int bottom = static_cast<int>(std::floor(-extent.min_y / map_resolution + 1e-9));
  const int width = std::max(1, right - turned.left + 1);
  const int height = std::max(1, bottom - turned.top + 1);
  for (auto* raster : {&turned.value, &turned.mask, &turned.weight, &turned.seen}) {
    *raster = Raster<float>(width, height);
  }

  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const double x = (turned.left + column) * map_resolution;
      const double y = -(turned.top + row) * map_resolution;
      const PixelCoordinate at = local.geo.pixel_at(cosine * x + sine * y, cosine * y - sine * x);
      if (at.column < 0.0 || at.row < 0.0 || at.column > local.value.width() ||
          at.row > local.value.height()) {
        continue;
      }
      const Sample sample = sample_seen(local, at);
      if (!sample.seen && !role.whole_square) continue;
      const double weight =
          role.weighted ? pixel_weight(role.weight, at, local.value.width(), local.value.height())
                        : 1.0;
      turned.value.at(column, row) = sample.seen ? static_cast<float>(sample.value) : kHoleGrey;
      turned.mask.at(column, row) = 1.0F;
      turned.weight.at(column, row) = static_cast<float>(weight);
      if (!sample.seen) continue;
      const double seen = role.weighted_norms ? weight : 1.0;
      turned.seen.at(column, row) = static_cast<float>(seen);
      turned.total_seen += seen;
    }
  }
  return turned;
}

std::vector<RotatedTemplate> rotate_templates(const ChannelImage& local,
                                              std::span<const double> yaws_rad,
                                              double map_resolution, const PixelRole& role) {
  std::vector<RotatedTemplate> templates(yaws_rad.size());
  tbb::parallel_for(std::size_t{0}, templates.size(), [&](std::size_t k) {
    templates[k] = rotate_template(local, yaws_rad[k], map_resolution, role);
  });
  return templates;
}

}  // namespace nadir
