// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/region.hpp"

#include <algorithm>

#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {

Region cut_region(const ChannelImage& map, std::span<const RotatedTemplate> templates,
                  const PixelWindow& window, bool whole_square) {
  int left = templates.front().left;
  int top = templates.front().top;
  int right = left;
  int bottom = top;
  for (const RotatedTemplate& local : templates) {
    left = std::min(left, local.left);
    top = std::min(top, local.top);
    right = std::max(right, local.left + local.value.width());
    bottom = std::max(bottom, local.top + local.value.height());
  }
  const int width = window.width + right - left - 1;
  const int height = window.height + bottom - top - 1;

  Region region{left, top, Raster<float>(width, height), Raster<float>(width, height),
                Raster<float>(width, height)};
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      const int u = window.left + left + column;
      const int v = window.top + top + row;
      const bool seen = map.value.contains(u, v) && map.valid.at(u, v) != 0;
      if (seen) region.valid.at(column, row) = 1.0F;
      if (!seen && !whole_square) continue;
      region.takes_part.at(column, row) = 1.0F;
      region.value.at(column, row) = seen ? map.value.at(u, v) : kHoleGrey;
    }
  }
  return region;
}

double mean_grey(const Raster<float>& value, const Raster<float>& mask) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < value.values().size(); ++i) {
    if (mask.values()[i] == 0.0F) continue;
    sum += value.values()[i];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : 0.0;
}

Raster<float> times(const Raster<float>& a, const Raster<float>& b) {
  Raster<float> product = a;
  for (std::size_t i = 0; i < product.values().size(); ++i) product.values()[i] *= b.values()[i];
  return product;
}

Raster<float> shifted(const Raster<float>& value, const Raster<float>& mask, double shift) {
  Raster<float> result = mask;
  for (std::size_t i = 0; i < result.values().size(); ++i) {
    result.values()[i] *= static_cast<float>((value.values()[i] - shift) / kGreyScale);
  }
  return result;
}

}  // namespace nadir::cpu
