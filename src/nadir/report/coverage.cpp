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
constexpr int kSeenCell = 4;           ///< pixels of a local map
constexpr double kBarRoom = 110.0;     ///< right of the map: the colour bar and its numbers

Region content_of(const std::vector<SeenGround>& local_maps) {
  Region content;
  for (const SeenGround& one : local_maps) {
    const auto& [pose, geo, width, height] = one.outline;
    if (!pose.is_finite()) continue;
    for (const auto& corner : outline_of(pose, geo, width, height)) {
      content.include(corner.x, corner.y);
    }
  }
  return content;
}

bool is_seen(const SeenGround& ground, const Point2<frames::Robot>& at) {
  const PixelCoordinate pixel = ground.outline.geo.pixel_at(at.x, at.y);
  const int column = static_cast<int>(std::floor(pixel.column / kSeenCell));
  const int row = static_cast<int>(std::floor(pixel.row / kSeenCell));
  return ground.valid.contains(column, row) && ground.valid.at(column, row) != 0;
}

/// Counts one for every cell whose middle has been seen.
void add(Raster<float>& count, const GeoReference& geo, const SeenGround& ground) {
  if (!ground.outline.map_from_robot.is_finite()) return;
  const Region around = content_of({ground});
  const PixelCoordinate first = geo.pixel_at(around.west, around.north);
  const PixelCoordinate last = geo.pixel_at(around.east, around.south);
  const auto robot_from_map = ground.outline.map_from_robot.inverse();
  const int last_row = std::min(static_cast<int>(last.row), count.height() - 1);
  const int last_column = std::min(static_cast<int>(last.column), count.width() - 1);
  for (int row = std::max(0, static_cast<int>(first.row)); row <= last_row; ++row) {
    for (int column = std::max(0, static_cast<int>(first.column)); column <= last_column;
         ++column) {
      const Point2<frames::Map> middle{geo.x_at(column + 0.5), geo.y_at(row + 0.5)};
      if (is_seen(ground, robot_from_map * middle)) count.at(column, row) += 1.0F;
    }
  }
}

struct Counted {
  Raster<float> count;  ///< NaN where nothing was seen
  GeoReference geo;
};

Counted count_of(const std::vector<SeenGround>& local_maps, const Region& content) {
  const double cell =
      std::max(kFinestCell, std::max(content.width(), content.height()) / kMostCells);
  Counted counted{Raster<float>(static_cast<int>(std::ceil(content.width() / cell)),
                                static_cast<int>(std::ceil(content.height() / cell))),
                  {content.west, content.north, cell, {}}};
  for (const SeenGround& ground : local_maps) add(counted.count, counted.geo, ground);
  for (float& value : counted.count.values()) {
    if (value == 0.0F) value = std::numeric_limits<float>::quiet_NaN();
  }
  return counted;
}

}  // namespace

SeenGround seen_ground(const Orthomosaic& local, const Pose2& map_from_robot) {
  const Raster<std::uint8_t>& pixels = local.valid;
  SeenGround ground{{map_from_robot, local.geo, local.width(), local.height()},
                    Raster<std::uint8_t>((pixels.width() + kSeenCell - 1) / kSeenCell,
                                         (pixels.height() + kSeenCell - 1) / kSeenCell)};
  for (int row = 0; row < ground.valid.height(); ++row) {
    for (int column = 0; column < ground.valid.width(); ++column) {
      int valid = 0;
      int all = 0;
      for (int v = kSeenCell * row; v < std::min(kSeenCell * (row + 1), pixels.height()); ++v) {
        for (int u = kSeenCell * column; u < std::min(kSeenCell * (column + 1), pixels.width());
             ++u) {
          ++all;
          if (pixels.at(u, v) != 0) ++valid;
        }
      }
      ground.valid.at(column, row) = 2 * valid >= all ? 1 : 0;
    }
  }
  return ground;
}

Figure draw_coverage(const Orthomosaic& map, const std::vector<SeenGround>& local_maps,
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
