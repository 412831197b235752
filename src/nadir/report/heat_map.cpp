// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <optional>

#include "nadir/report/colour_bar.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/heat_map_layout.hpp"
#include "nadir/report/imagery.hpp"

namespace nadir {
namespace {

using namespace report;

// Low scores leave more of the map to be seen.
constexpr double kLowestOpacity = 0.45;
constexpr double kHighestOpacity = 0.85;

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

/// Range of the finite scores; nothing where there is none.
std::optional<ColourScale> scale_of(const Raster<float>& score) {
  std::optional<ColourScale> scale;
  for (const float value : score.values()) {
    if (!std::isfinite(value)) continue;
    const auto number = static_cast<double>(value);
    if (!scale) scale = ColourScale{number, number, "score"};
    scale->low = std::min(scale->low, number);
    scale->high = std::max(scale->high, number);
  }
  return scale;
}

/// The scores as a picture: a pixel each, valid where the score is defined.
Orthomosaic coloured(const Raster<float>& score, const GeoReference& geo,
                     const ColourScale& scale) {
  Orthomosaic picture{Raster<std::uint8_t>(score.width(), score.height(), 0, 3),
                      Raster<std::uint8_t>(score.width(), score.height()), geo};
  const double span = scale.high > scale.low ? scale.high - scale.low : 1.0;
  for (int row = 0; row < score.height(); ++row) {
    for (int column = 0; column < score.width(); ++column) {
      const auto value = static_cast<double>(score.at(column, row));
      if (!std::isfinite(value)) continue;
      const Colour colour = mapped_colour(ColourMap::kInferno, (value - scale.low) / span);
      picture.image.at(column, row, 0) = colour.red;
      picture.image.at(column, row, 1) = colour.green;
      picture.image.at(column, row, 2) = colour.blue;
      picture.valid.at(column, row) = 255;
    }
  }
  return picture;
}

void draw_overlay(Canvas& canvas, const MapView& view, const Orthomosaic& picture) {
  const double step =
      1.0 / (view.pixels_per_metre() * Canvas::kOversampling * picture.geo.resolution);
  const PixelCoordinate corner = picture.geo.pixel_at(view.region.west, view.region.north);
  Imagery imagery = resample(picture, {step, 0.0, corner.column, 0.0, step, corner.row},
                             fine_pixels(view.box.width), fine_pixels(view.box.height));
  for (std::size_t i = 0; i < imagery.opacity.values().size(); ++i) {
    // The colour map is as bright as the score is high.
    const double bright =
        std::max(imagery.colour.values()[3 * i], imagery.colour.values()[3 * i + 1]);
    const double share = kLowestOpacity + (kHighestOpacity - kLowestOpacity) * bright / 255.0;
    std::uint8_t& opacity = imagery.opacity.values()[i];
    opacity = static_cast<std::uint8_t>(std::lround(share * opacity));
  }
  canvas.clip(view.box);
  canvas.image(view.box, imagery.colour, imagery.opacity);
  canvas.unclip();
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

/// Draws a cut-out of `source` upright in the robot's frame: what the footprint covers.
/// `source_from_robot` takes robot coordinates to those of the source's geo-reference.
template <class To>
Imagery seen_from(const Transform2<To, frames::Robot>& source_from_robot, const Orthomosaic& source,
                  const Footprint& footprint, int width, int height) {
  const double right = footprint.geo.resolution * footprint.width / width;
  const double down = footprint.geo.resolution * footprint.height / height;
  const auto pixel = [&](double u, double v) {
    const auto point = source_from_robot * Point2<frames::Robot>{footprint.geo.west + u * right,
                                                                 footprint.geo.north - v * down};
    return source.geo.pixel_at(point.x, point.y);
  };
  const PixelCoordinate origin = pixel(0.0, 0.0);
  const PixelCoordinate east = pixel(1.0, 0.0);
  const PixelCoordinate south = pixel(0.0, 1.0);
  return resample(source,
                  {east.column - origin.column, south.column - origin.column, origin.column,
                   east.row - origin.row, south.row - origin.row, origin.row},
                  width, height);
}

/// Squares of the one and of the other in turn: edges run on where both agree.
Imagery checkerboard(const Imagery& one, const Imagery& other) {
  constexpr int kSquares = 6;
  Imagery mixed = one;
  const int side = std::max(1, std::max(mixed.colour.width(), mixed.colour.height()) / kSquares);
  for (int row = 0; row < mixed.colour.height(); ++row) {
    for (int column = 0; column < mixed.colour.width(); ++column) {
      if ((row / side + column / side) % 2 == 0) continue;
      for (int channel = 0; channel < 3; ++channel) {
        mixed.colour.at(column, row, channel) = other.colour.at(column, row, channel);
      }
      mixed.opacity.at(column, row) = other.opacity.at(column, row);
    }
  }
  return mixed;
}

void draw_patch(Canvas& canvas, const Box& box, const Imagery& imagery, const char* caption) {
  const Box frame{box.left, box.top,
                  static_cast<double>(imagery.colour.width()) / Canvas::kOversampling,
                  static_cast<double>(imagery.colour.height()) / Canvas::kOversampling};
  draw_hatching(canvas, frame);
  canvas.image(frame, imagery.colour, imagery.opacity);
  canvas.outline(frame.corners(), {kFrame, 1.5, {}, 0.0});
  canvas.fitted_text({box.left, box.top - 20.0}, caption, box.width,
                     {22.0, kInk, Align::kLeft, false, {}});
}

void draw_patches(Canvas& canvas, const HeatMapLayout& layout, const Orthomosaic& map,
                  const Orthomosaic& local, const Footprint& found) {
  if (local.image.empty()) return;
  const Footprint footprint{found.map_from_robot, local.geo, local.width(), local.height()};
  const double scale = kPatchSide / std::max(local.width(), local.height());
  const int width = fine_pixels(scale * local.width());
  const int height = fine_pixels(scale * local.height());
  const Transform2<frames::Robot, frames::Robot> as_it_is;
  const Imagery seen = seen_from(as_it_is, local, footprint, width, height);
  draw_patch(canvas, layout.patches[0], seen, "local map, x forward to the right");
  if (!found.map_from_robot.is_finite()) return;
  const Imagery mapped = seen_from(found.map_from_robot, map, footprint, width, height);
  draw_patch(canvas, layout.patches[1], mapped, "map at the found pose");
  draw_patch(canvas, layout.patches[2], checkerboard(mapped, seen), "both, in turn");
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
  const std::optional<ColourScale> scale = scale_of(score);
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, heat_map.title);
  draw_map(canvas, layout.view, map, Tint::kGrey);
  if (scale) {
    draw_overlay(canvas, layout.view, coloured(score, heat_map.volume->geo, *scale));
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
