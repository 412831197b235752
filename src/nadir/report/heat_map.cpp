// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "nadir/report/colour_bar.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/heat_map_layout.hpp"
#include "nadir/report/overlay.hpp"
#include "nadir/report/patches.hpp"

namespace nadir {
namespace {

using namespace report;

Region region_of(const ScoreVolume& volume) {
  if (volume.score.empty()) return {};
  return extent_of(volume.geo, volume.score.front().width(), volume.score.front().height());
}

std::vector<Point2<frames::Map>> outline_of(const Footprint& footprint) {
  return report::outline_of(footprint.map_from_robot, footprint.geo, footprint.width,
                            footprint.height);
}

void include(Region& region, const Footprint& footprint) {
  for (const auto& corner : outline_of(footprint)) region.include(corner.x, corner.y);
}

Region content_of(const HeatMap& heat_map) {
  Region region;
  if (heat_map.volume != nullptr) region = region_of(*heat_map.volume);
  include(region, heat_map.found);
  if (heat_map.truth) include(region, *heat_map.truth);
  return region;
}

/// The outline of a local map, its middle, and a wedge at the middle of its front edge.
void draw_footprint(Canvas& canvas, const MapView& view, const Footprint& footprint,
                    const Stroke& stroke) {
  if (!footprint.map_from_robot.is_finite() || footprint.width <= 0) return;
  std::vector<Position> corners;
  for (const auto& corner : outline_of(footprint)) corners.push_back(view.at(corner));
  canvas.outline(corners, stroke);
  const Position front{0.5 * (corners[0].x + corners[1].x), 0.5 * (corners[0].y + corners[1].y)};
  const double yaw = footprint.map_from_robot.yaw;
  const auto ahead = [&](double forward, double left) {
    return Position{front.x + forward * std::cos(yaw) - left * std::sin(yaw),
                    front.y - forward * std::sin(yaw) - left * std::cos(yaw)};
  };
  const std::vector<Position> wedge{ahead(0.0, 13.0), ahead(20.0, 0.0), ahead(0.0, -13.0)};
  canvas.outline(wedge, {*stroke.halo, 4.0, {}, 0.0});
  canvas.fill(wedge, stroke.colour);
  const Position robot = view.at(footprint.map_from_robot.x, footprint.map_from_robot.y);
  canvas.disc(robot, 7.5, *stroke.halo);
  canvas.disc(robot, 5.5, stroke.colour);
}

// Where both boxes agree the narrow truth lies inside the wide found one, and both are seen.
Stroke found_stroke() { return {kPaper, 9.0, kInk, 0.0}; }
Stroke truth_stroke() { return {kTruthBlue, 3.5, kPaper, 0.0}; }
Stroke window_stroke() { return {kSearchRed, 4.0, kPaper, 16.0}; }

void draw_window(Canvas& canvas, const MapView& view, const Region& window) {
  const Position corner = view.at(window.west, window.north);
  const Position opposite = view.at(window.east, window.south);
  canvas.outline(Box{corner.x, corner.y, opposite.x - corner.x, opposite.y - corner.y}.corners(),
                 window_stroke());
}

void draw_patches(Canvas& canvas, const HeatMapLayout& layout, const Orthomosaic& map,
                  const Orthomosaic& local, const Footprint& found) {
  if (local.image.empty()) return;
  const Patches patches = patches_of(map, local, found.map_from_robot, kPatchSide);
  draw_patch(canvas, layout.patches[0], patches.local, "local map, x forward to the right");
  if (!patches.map) return;
  draw_patch(canvas, layout.patches[1], *patches.map, "map at the found pose");
  draw_patch(canvas, layout.patches[2], *patches.both, "both, in turn");
}

LegendEntry box_entry(const std::string& name, const Stroke& stroke) {
  return {name, "", [stroke](Canvas& canvas, const Box& box) {
            const Box sample{box.left + 16.0, box.top + 1.0, 32.0, 32.0};
            canvas.fill(sample.inset(-9.0).corners(), kFrame);
            canvas.outline(sample.corners(), stroke);
          }};
}

/// The entries side by side where the legend lies below, one above the other beside the patches.
void draw_box_legend(Canvas& canvas, const HeatMapLayout& layout, const HeatMap& heat_map) {
  std::vector<LegendEntry> entries{box_entry("found", found_stroke())};
  if (heat_map.truth) entries.push_back(box_entry("truth", truth_stroke()));
  if (!heat_map.whole_map) entries.push_back(box_entry("search window", window_stroke()));
  const bool in_a_row = layout.legend.height > 0.0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const auto shift = static_cast<double>(i);
    const Box box{layout.legend.left + (in_a_row ? 230.0 * shift : 0.0),
                  layout.legend.top + (in_a_row ? 0.0 : 64.0 * shift), 340.0, 66.0};
    draw_legend(canvas, box, {entries[i]});
  }
}

}  // namespace

Figure draw_heat_map(const Orthomosaic& map, const Orthomosaic& local, const HeatMap& heat_map) {
  const Region extent = extent_of(map.geo, map.width(), map.height());
  const Region region = heat_map.whole_map && !extent.empty
                            ? extent
                            : region_of_interest(content_of(heat_map), extent, 2.0);
  const HeatMapLayout layout = lay_out_heat_map(region);
  const Raster<float> score =
      heat_map.volume == nullptr ? Raster<float>{} : heat_map.volume->best_over_headings();
  const std::optional<ColourScale> scale = scale_of(score, "score");
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, heat_map.title);
  draw_map(canvas, layout.view, map, Tint::kGrey);
  if (scale) {
    draw_overlay(canvas, layout.view,
                 coloured(score, heat_map.volume->geo, *scale, ColourMap::kInferno));
    draw_colour_bar(canvas, layout.bar, ColourMap::kInferno, *scale);
  } else {
    const Box& box = layout.view.box;
    draw_note(canvas, {box.left, box.top, box.width, 80.0}, "no score is defined here");
  }
  canvas.clip(layout.view.box);
  if (!heat_map.whole_map && !score.empty()) {
    draw_window(canvas, layout.view, region_of(*heat_map.volume));
  }
  draw_footprint(canvas, layout.view, heat_map.found, found_stroke());
  if (heat_map.truth) draw_footprint(canvas, layout.view, *heat_map.truth, truth_stroke());
  canvas.unclip();
  draw_map_axes(canvas, layout.view);
  draw_patches(canvas, layout, map, local, heat_map.found);
  draw_box_legend(canvas, layout, heat_map);
  draw_furniture(canvas, layout.view, layout.furniture);
  return canvas.finish();
}

}  // namespace nadir
