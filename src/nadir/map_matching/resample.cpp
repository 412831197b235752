// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/resample.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace nadir {
namespace {

/// How much of which input pixels a cell covers along one axis.
struct Coverage {
  int first = 0;
  std::vector<float> share;  ///< in input pixels
};

std::vector<Coverage> axis_coverage(int input_size, double ratio) {
  const int cells = std::max(1, static_cast<int>(std::ceil(input_size / ratio - 1e-6)));
  std::vector<Coverage> coverage(static_cast<std::size_t>(cells));
  for (int cell = 0; cell < cells; ++cell) {
    const double begin = cell * ratio;
    const double end = std::min((cell + 1) * ratio, static_cast<double>(input_size));
    Coverage& entry = coverage[static_cast<std::size_t>(cell)];
    entry.first = std::min(static_cast<int>(std::floor(begin)), input_size - 1);
    for (int pixel = entry.first; pixel < end && pixel < input_size; ++pixel) {
      const double overlap =
          std::min(end, pixel + 1.0) - std::max(begin, static_cast<double>(pixel));
      entry.share.push_back(static_cast<float>(std::max(overlap, 0.0)));
    }
  }
  return coverage;
}

struct WeightedSum {
  float value = 0.0F;
  float weight = 0.0F;
};

}  // namespace

GreyImage resample(const GreyImage& image, double resolution) {
  const double ratio = resolution / image.geo.resolution;
  if (std::abs(ratio - 1.0) < 1e-9) return image;
  const std::vector<Coverage> columns = axis_coverage(image.value.width(), ratio);
  const std::vector<Coverage> rows = axis_coverage(image.value.height(), ratio);

  GreyImage result;
  result.value = Raster<float>(static_cast<int>(columns.size()), static_cast<int>(rows.size()));
  result.valid = Raster<std::uint8_t>(result.value.width(), result.value.height());
  result.geo = image.geo;
  result.geo.resolution = resolution;

  for (int row = 0; row < result.value.height(); ++row) {
    const Coverage& vertical = rows[static_cast<std::size_t>(row)];
    for (int column = 0; column < result.value.width(); ++column) {
      const Coverage& horizontal = columns[static_cast<std::size_t>(column)];
      WeightedSum sum;
      float area = 0.0F;
      for (std::size_t j = 0; j < vertical.share.size(); ++j) {
        for (std::size_t i = 0; i < horizontal.share.size(); ++i) {
          const int x = horizontal.first + static_cast<int>(i);
          const int y = vertical.first + static_cast<int>(j);
          const float share = vertical.share[j] * horizontal.share[i];
          area += share;
          if (image.valid.at(x, y) == 0) continue;
          sum.value += share * image.value.at(x, y);
          sum.weight += share;
        }
      }
      if (sum.weight <= 0.0F || sum.weight < 0.5F * area) continue;
      result.value.at(column, row) = sum.value / sum.weight;
      result.valid.at(column, row) = 1;
    }
  }
  return result;
}

}  // namespace nadir
