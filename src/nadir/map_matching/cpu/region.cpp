// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/cpu/region.hpp"

#include <algorithm>

#include "nadir/map_matching/cpu/sums.hpp"

namespace nadir::cpu {
namespace {

struct Interval {
  int begin = 0;
  int end = 0;  ///< one beyond
};

/// The part of `range` inside 0 .. size; where there is none, one pixel of it, a hole.
Interval within(const Interval& range, int size) {
  const Interval inside{std::max(range.begin, 0), std::min(range.end, size)};
  return inside.begin < inside.end ? inside : Interval{range.begin, range.begin + 1};
}

/// No two pixels of `touched`, one of them in `kept`, may fall together; nor two of a template,
/// which may be larger than the map.
int period(const Interval& touched, const Interval& kept, int template_size) {
  return std::max({touched.end - kept.begin, kept.end - touched.begin, template_size});
}

}  // namespace

TemplateBounds bounds_of(std::span<const RotatedTemplate> templates) {
  TemplateBounds bounds{templates.front().left, templates.front().top, templates.front().left,
                        templates.front().top};
  for (const RotatedTemplate& local : templates) {
    bounds.left = std::min(bounds.left, local.left);
    bounds.top = std::min(bounds.top, local.top);
    bounds.right = std::max(bounds.right, local.left + local.value.width());
    bounds.bottom = std::max(bounds.bottom, local.top + local.value.height());
  }
  return bounds;
}

RegionPlace place_region(const ChannelImage& map, std::span<const RotatedTemplate> templates,
                         const PixelWindow& window, RegionExtent extent) {
  const TemplateBounds bounds = bounds_of(templates);
  const Interval columns{window.left + bounds.left, window.left + window.width - 1 + bounds.right};
  const Interval rows{window.top + bounds.top, window.top + window.height - 1 + bounds.bottom};
  const bool clip = extent == RegionExtent::kWithinMap;
  const Interval u_range = clip ? within(columns, map.value.width()) : columns;
  const Interval v_range = clip ? within(rows, map.value.height()) : rows;
  return {u_range.begin - window.left,
          v_range.begin - window.top,
          u_range.end - u_range.begin,
          v_range.end - v_range.begin,
          period(columns, u_range, bounds.right - bounds.left),
          period(rows, v_range, bounds.bottom - bounds.top)};
}

Region cut_region(const ChannelImage& map, const RegionPlace& place, const PixelWindow& window,
                  bool whole_square) {
  Region region{place, Raster<float>(place.width, place.height),
                Raster<float>(place.width, place.height), Raster<float>(place.width, place.height)};
  for (int row = 0; row < place.height; ++row) {
    for (int column = 0; column < place.width; ++column) {
      const int u = window.left + place.left + column;
      const int v = window.top + place.top + row;
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
