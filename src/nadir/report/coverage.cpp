// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/report/figures.hpp"
#include "nadir/report/map_figure.hpp"
#include "nadir/report/overlay.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr double kMostCells = 1000.0;  ///< along a side
constexpr double kFinestCell = 0.1;    ///< metres
constexpr double kBarRoom = 110.0;     ///< right of the map: the colour bar and its numbers

Region content_of(const std::vector<Footprint>& local_maps) {
  Region content;
  for (const Footprint& one : local_maps) {
    if (!one.map_from_robot.is_finite()) continue;
    for (const auto& corner : outline_of(one.map_from_robot, one.geo, one.width, one.height)) {
      content.include(corner.x, corner.y);
    }
  }
  return content;
}

/// Counts one for every cell whose middle lies in the outline.
void add(Raster<float>& count, const GeoReference& geo, const Footprint& footprint) {
  if (!footprint.map_from_robot.is_finite()) return;
  const Region seen = content_of({footprint});
  const PixelCoordinate first = geo.pixel_at(seen.west, seen.north);
  const PixelCoordinate last = geo.pixel_at(seen.east, seen.south);
  const auto robot_from_map = footprint.map_from_robot.inverse();
  const double east = footprint.geo.x_at(footprint.width);
  const double south = footprint.geo.y_at(footprint.height);
  const int last_row = std::min(static_cast<int>(last.row), count.height() - 1);
  const int last_column = std::min(static_cast<int>(last.column), count.width() - 1);
  for (int row = std::max(0, static_cast<int>(first.row)); row <= last_row; ++row) {
    for (int column = std::max(0, static_cast<int>(first.column)); column <= last_column;
         ++column) {
      const Point2<frames::Map> middle{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      const Point2<frames::Robot> p = robot_from_map * middle;
      const bool inside =
          p.x >= footprint.geo.west && p.x < east && p.y <= footprint.geo.north && p.y > south;
      if (inside) count.at(column, row) += 1.0F;
    }
  }
}

struct Counted {
  Raster<float> count;  ///< NaN where nothing was seen
  GeoReference geo;
};

Counted count_of(const std::vector<Footprint>& local_maps, const Region& content) {
  const double cell =
      std::max(kFinestCell, std::max(content.width(), content.height()) / kMostCells);
  Counted counted{Raster<float>(static_cast<int>(std::ceil(content.width() / cell)),
                                static_cast<int>(std::ceil(content.height() / cell))),
                  {content.west, content.north, cell, {}}};
  for (const Footprint& footprint : local_maps) add(counted.count, counted.geo, footprint);
  for (float& value : counted.count.values()) {
    if (value == 0.0F) value = std::numeric_limits<float>::quiet_NaN();
  }
  return counted;
}

}  // namespace

Figure draw_coverage(const Orthomosaic& map, const std::vector<Footprint>& local_maps,
                     const std::string& title) {
  const Region content = content_of(local_maps);
  MapLayout layout = lay_out_map(
      region_of_interest(content, extent_of(map.geo, map.width(), map.height()), 3.0), 0);
  const Box& box = layout.view.box;
  // Beside a tall map there is room for the bar already.
  const bool beside = layout.furniture.left > box.right();
  Canvas canvas(layout.width + (beside ? 0 : static_cast<int>(kBarRoom)), layout.height);
  draw_title(canvas, title);
  draw_map(canvas, layout.view, map, Tint::kGrey);
  std::optional<ColourScale> scale;
  if (!content.empty) {
    const Counted counted = count_of(local_maps, content);
    scale = scale_of(counted.count, "local maps");
    if (scale) {
      scale->low = 0.0;
      draw_overlay(canvas, layout.view,
                   coloured(counted.count, counted.geo, *scale, ColourMap::kViridis));
      draw_colour_bar(canvas,
                      {box.right() + 30.0, box.top + 40.0, 26.0,
                       std::min(640.0, std::max(60.0, box.height - 40.0 - 130.0))},
                      ColourMap::kViridis, *scale);
    }
  }
  if (!scale) draw_note(canvas, box, "nothing to show: no local map");
  draw_map_axes(canvas, layout.view);
  draw_furniture(canvas, layout.view, layout.furniture);
  return canvas.finish();
}

}  // namespace nadir
