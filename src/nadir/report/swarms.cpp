// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numeric>

#include "nadir/report/colour_bar.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/map_figure.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr double kInsetGap = 26.0;
constexpr double kLegendHeight = 66.0;

/// Where everything of a swarm figure lies.
struct Layout {
  int width = 0;
  int height = 0;
  MapView overview;
  std::vector<Box> insets;
  Box legend;
};

Region region_of(const Swarm& swarm) {
  Region region;
  for (const Pose2& particle : swarm.particles) region.include(particle.x, particle.y);
  region.include(swarm.estimate.x, swarm.estimate.y);
  if (swarm.truth) region.include(swarm.truth->x, swarm.truth->y);
  return region;
}

/// A square that shows the whole swarm.
Region inset_region(const Swarm& swarm) {
  constexpr double kLeast = 2.5;  // metres
  Region region = region_of(swarm);
  if (region.empty) region.include(0.0, 0.0);
  const double side = std::max({kLeast, 1.16 * region.width(), 1.16 * region.height()});
  return region.at_least(side, side);
}

/// Squares in rows: as large as the area allows.
std::vector<Box> grid(const Box& area, std::size_t count) {
  std::size_t best_columns = 1;
  double best_side = 0.0;
  for (std::size_t columns = 1; columns <= count; ++columns) {
    const std::size_t rows = (count + columns - 1) / columns;
    const double across = (area.width + kInsetGap) / static_cast<double>(columns) - kInsetGap;
    const double down =
        (area.height + kInsetGap) / static_cast<double>(rows) - kInsetGap - kCaption;
    const double side = std::min(across, down);
    if (side > best_side) {
      best_side = side;
      best_columns = columns;
    }
  }
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t column = i % best_columns;
    const std::size_t row = i / best_columns;
    boxes.push_back(
        {area.left + static_cast<double>(column) * (best_side + kInsetGap),
         area.top + kCaption + static_cast<double>(row) * (best_side + kInsetGap + kCaption),
         best_side, best_side});
  }
  return boxes;
}

Layout lay_out_beside(const Region& region, std::size_t count) {
  constexpr double kHeight = 1340.0;
  constexpr double kInsetsWidth = 1130.0;
  Layout layout;
  const double top = kMargin + kTitleHeight;
  layout.overview = fit(region, {kMargin + tick_room(region), top + kCaption, 900.0, kHeight});
  const Box& map = layout.overview.box;
  const double left = map.right() + 1.6 * kInsetGap;
  layout.insets = grid({left, top, kInsetsWidth, map.height + kCaption}, count);
  double right = left + 300.0;
  for (const Box& inset : layout.insets) right = std::max(right, inset.right());
  layout.width = static_cast<int>(right + kMargin);
  layout.legend = {map.left, map.bottom() + kTickRoom + 24.0, right - map.left, kLegendHeight};
  layout.height = static_cast<int>(layout.legend.bottom() + kMargin);
  return layout;
}

Layout lay_out_above(const Region& region, std::size_t count) {
  constexpr double kWidth = 1760.0;
  constexpr double kInset = 410.0;
  Layout layout;
  const double left = kMargin + tick_room(region);
  layout.overview = fit(region, {left, kMargin + kTitleHeight, kWidth, 900.0});
  const Box& map = layout.overview.box;
  const double top = map.bottom() + kTickRoom + 14.0;
  const std::size_t full_rows = (count + 3) / 4;
  const auto rows = static_cast<double>(full_rows);
  layout.insets =
      grid({left, top, map.width, rows * (kInset + kCaption) + (rows - 1.0) * kInsetGap}, count);
  double bottom = top;
  for (const Box& inset : layout.insets) bottom = std::max(bottom, inset.bottom());
  layout.width = static_cast<int>(map.right() + kMargin);
  layout.legend = {left, bottom + 40.0, map.width, kLegendHeight};
  layout.height = static_cast<int>(layout.legend.bottom() + kMargin);
  return layout;
}

Layout lay_out(const Region& region, std::size_t count) {
  return region.height() > 0.85 * region.width() ? lay_out_beside(region, count)
                                                 : lay_out_above(region, count);
}

constexpr std::size_t kMostDrawn = 1500;
constexpr std::size_t kHeaviestDrawn = 500;

/// Particles from the lightest to the heaviest, so that the heavy ones end up on top. Of a dense
/// cloud the heaviest and an even sample of the others: all of them would hide the map.
std::vector<std::size_t> drawn_particles(const Swarm& swarm) {
  std::vector<std::size_t> order(std::min(swarm.particles.size(), swarm.weights.size()));
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return swarm.weights[a] < swarm.weights[b];
  });
  if (order.size() <= kMostDrawn) return order;
  const std::size_t light = order.size() - kHeaviestDrawn;
  const std::size_t sampled = kMostDrawn - kHeaviestDrawn;
  std::vector<std::size_t> drawn;
  for (std::size_t k = 0; k < sampled; ++k) drawn.push_back(order[k * light / sampled]);
  drawn.insert(drawn.end(), order.end() - static_cast<std::ptrdiff_t>(kHeaviestDrawn), order.end());
  return drawn;
}

double heaviest(const Swarm& swarm) {
  double most = 0.0;
  for (const double weight : swarm.weights) most = std::max(most, weight);
  return most > 0.0 ? most : 1.0;
}

void draw_pose(Canvas& canvas, const MapView& view, const Pose2& pose, Colour colour,
               double length) {
  const Position at = view.at(pose.x, pose.y);
  if (!pose.is_finite()) return;
  const Position tip{at.x + length * std::cos(pose.yaw), at.y - length * std::sin(pose.yaw)};
  canvas.arrow(at, tip, {colour, 5.0, kInk, 0.0});
  canvas.disc(at, 9.0, kInk);
  canvas.disc(at, 7.4, colour);
}

/// Every particle as a dot with a tick in its heading, coloured by its weight.
void draw_particles(Canvas& canvas, const MapView& view, const Swarm& swarm) {
  constexpr double kTick = 11.0;
  const double most = heaviest(swarm);
  for (const std::size_t i : drawn_particles(swarm)) {
    const Pose2& particle = swarm.particles[i];
    if (!particle.is_finite()) continue;
    const Colour colour = mapped_colour(ColourMap::kViridis, swarm.weights[i] / most);
    const Position at = view.at(particle.x, particle.y);
    const Position tip{at.x + kTick * std::cos(particle.yaw),
                       at.y - kTick * std::sin(particle.yaw)};
    canvas.line({at, tip}, {colour, 1.6, {}, 0.0});
    canvas.disc(at, 3.2, kInk, 0.55);
    canvas.disc(at, 2.5, colour);
  }
}

void draw_inset(Canvas& canvas, const Orthomosaic& map, const Box& box, const Swarm& swarm,
                const std::string& number) {
  const MapView view = fit(inset_region(swarm), box);
  draw_map(canvas, view, map, Tint::kGrey);
  canvas.clip(box);
  draw_particles(canvas, view, swarm);
  if (swarm.truth) draw_pose(canvas, view, *swarm.truth, kSkyBlue, 84.0);
  draw_pose(canvas, view, swarm.estimate, kVermillion, 62.0);
  canvas.unclip();
  canvas.outline(box.corners(), {kInk, 2.0, {}, 0.0});
  draw_scale_bar(canvas, view, {box.left + 16.0, box.bottom() - 46.0}, 0.34 * box.width, true);
  const Position badge{box.left + 16.0, box.top - 22.0};
  canvas.disc(badge, 16.0, kInk);
  canvas.text(badge, number, {19.0, kPaper, Align::kCentre, true, {}});
  canvas.fitted_text({box.left + 42.0, box.top - 22.0}, swarm.label, box.width - 44.0,
                     {24.0, kInk, Align::kLeft, false, {}});
}

void draw_in_overview(Canvas& canvas, const MapView& view, const Swarm& swarm) {
  const double most = heaviest(swarm);
  for (const std::size_t i : drawn_particles(swarm)) {
    const Pose2& particle = swarm.particles[i];
    if (!particle.is_finite()) continue;
    canvas.disc(view.at(particle.x, particle.y), 2.2,
                mapped_colour(ColourMap::kViridis, swarm.weights[i] / most), 0.7);
  }
  if (swarm.truth) draw_pose(canvas, view, *swarm.truth, kSkyBlue, 42.0);
  draw_pose(canvas, view, swarm.estimate, kVermillion, 30.0);
}

/// The square that an inset shows, with the inset's number at a corner.
void draw_inset_frame(Canvas& canvas, const MapView& view, const Region& region,
                      const std::string& number) {
  const Position corner = view.at(region.west, region.north);
  const Position opposite = view.at(region.east, region.south);
  const Box box{corner.x, corner.y, opposite.x - corner.x, opposite.y - corner.y};
  canvas.clip(view.box);
  canvas.outline(box.corners(), {kPaper, 2.4, kInk, 0.0});
  canvas.unclip();
  const Position badge{std::clamp(box.right(), view.box.left + 16.0, view.box.right() - 16.0),
                       std::clamp(box.top, view.box.top + 16.0, view.box.bottom() - 16.0)};
  canvas.disc(badge, 15.0, kPaper);
  canvas.disc(badge, 13.5, kInk);
  canvas.text(badge, number, {16.0, kPaper, Align::kCentre, true, {}});
}

LegendEntry pose_entry(const std::string& name, Colour colour) {
  return {
      name, "", [colour](Canvas& canvas, const Box& box) {
        const MapView view{{0.0, 0.0, 1.0, 1.0, false}, box};
        draw_pose(canvas, view, Pose2{0.1, 1.0 - 0.5 * box.height / box.width, 0.0}, colour, 50.0);
      }};
}

void draw_swarm_legend(Canvas& canvas, const Layout& layout, bool with_truth) {
  std::vector<LegendEntry> entries{pose_entry("estimate", kVermillion)};
  if (with_truth) entries.push_back(pose_entry("truth", kSkyBlue));
  const Box& box = layout.legend;
  constexpr double kEntry = 220.0;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const double left = box.left + kEntry * static_cast<double>(i);
    draw_legend(canvas, {left, box.top, kEntry, box.height}, {entries[i]});
  }
  draw_colour_bar(canvas, {box.left + 2.0 * kEntry + 20.0, box.top + 10.0, 330.0, 22.0},
                  ColourMap::kViridis, {0.0, 1.0, "particle weight / largest weight"});
  draw_north_arrow(canvas, {box.right() - 30.0, box.top - 8.0}, 84.0);
}

}  // namespace

Figure draw_swarms(const Orthomosaic& map, const std::vector<Swarm>& swarms,
                   const std::string& title) {
  Region content;
  for (const Swarm& swarm : swarms) {
    const Region region = region_of(swarm);
    if (region.empty) continue;
    content.include(region.west, region.south);
    content.include(region.east, region.north);
  }
  const Region region =
      region_of_interest(content, extent_of(map.geo, map.width(), map.height()), 4.0);
  const Layout layout = lay_out(region, swarms.size());
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, title);
  draw_map(canvas, layout.overview, map, Tint::kGrey);
  canvas.clip(layout.overview.box);
  for (const Swarm& swarm : swarms) draw_in_overview(canvas, layout.overview, swarm);
  canvas.unclip();
  draw_map_axes(canvas, layout.overview);
  for (std::size_t i = 0; i < swarms.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    draw_inset_frame(canvas, layout.overview, inset_region(swarms[i]), number);
    draw_inset(canvas, map, layout.insets[i], swarms[i], number);
  }
  if (swarms.empty()) {
    draw_note(canvas, layout.overview.box, "nothing to show: no swarm");
    return canvas.finish();
  }
  const bool with_truth = std::any_of(swarms.begin(), swarms.end(),
                                      [](const Swarm& swarm) { return swarm.truth.has_value(); });
  draw_swarm_legend(canvas, layout, with_truth);
  return canvas.finish();
}

}  // namespace nadir
