// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "nadir/report/figures.hpp"
#include "nadir/report/map_figure.hpp"
#include "nadir/report/patches.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr double kSide = 420.0;
constexpr double kPictureGap = 30.0;

double row_height(const Comparison& comparison) {
  const double longer = std::max({1, comparison.local.width(), comparison.local.height()});
  return kCaption + kSide * std::max(1, comparison.local.height()) / longer;
}

Box column_box(std::size_t column, double top) {
  return {kMargin + (kSide + kPictureGap) * static_cast<double>(column), top, kSide, kSide};
}

/// From the corner of a patch to the north of the map, as the robot sees it.
void draw_north(Canvas& canvas, const Box& patch, double yaw) {
  constexpr double kHalf = 26.0;
  const Position middle{patch.left + 40.0, patch.top + 40.0};
  // The robot's x points to the right: north lies a quarter turn minus its heading from there.
  const Position ahead{std::sin(yaw), -std::cos(yaw)};
  canvas.disc(middle, 33.0, kPaper, 0.75);
  canvas.arrow({middle.x - kHalf * ahead.x, middle.y - kHalf * ahead.y},
               {middle.x + kHalf * ahead.x, middle.y + kHalf * ahead.y}, {kInk, 4.0, {}, 0.0});
  canvas.text({middle.x + 46.0, middle.y}, "N", {24.0, kInk, Align::kCentre, true, kPaper});
}

void draw_scale(Canvas& canvas, const Box& patch, const Orthomosaic& local) {
  const double longer = std::max(local.width(), local.height());
  const double width_m = local.geo.resolution * local.width();
  const MapView view{{0.0, 0.0, width_m, width_m, false},
                     {0.0, 0.0, kSide * local.width() / longer, kSide}};
  const double bottom = patch.top + kSide * local.height() / longer;
  draw_scale_bar(canvas, view, {patch.left + 16.0, bottom - 44.0}, 0.5 * kSide, true);
}

void draw_row(Canvas& canvas, const Orthomosaic& map, const Comparison& comparison, double top) {
  const std::string label = comparison.label + ", x forward to the right";
  if (comparison.local.image.empty()) {
    draw_note(canvas, column_box(0, top), comparison.label + ": no local map");
    return;
  }
  const Patches patches = patches_of(map, comparison.local, comparison.map_from_robot, kSide);
  draw_patch(canvas, column_box(0, top), patches.local, label.c_str());
  draw_scale(canvas, column_box(0, top), comparison.local);
  if (!patches.map) {
    draw_note(canvas, column_box(1, top), "no pose");
    return;
  }
  draw_patch(canvas, column_box(1, top), *patches.map, "map at the estimated pose");
  draw_north(canvas, column_box(1, top), comparison.map_from_robot.yaw);
  draw_patch(canvas, column_box(2, top), *patches.both, "both, in turn");
}

}  // namespace

Figure draw_comparisons(const Orthomosaic& map, const std::vector<Comparison>& comparisons,
                        const std::string& title) {
  double height = kMargin + kTitleHeight;
  for (const Comparison& comparison : comparisons) height += row_height(comparison) + kPictureGap;
  if (comparisons.empty()) height += kSide;
  Canvas canvas(static_cast<int>(2.0 * kMargin + 3.0 * kSide + 2.0 * kPictureGap),
                static_cast<int>(height + kMargin - kPictureGap));
  draw_title(canvas, title);
  double top = kMargin + kTitleHeight + kCaption;
  for (const Comparison& comparison : comparisons) {
    draw_row(canvas, map, comparison, top);
    top += row_height(comparison) + kPictureGap;
  }
  if (comparisons.empty()) {
    draw_note(canvas, column_box(1, top), "nothing to show: no local map");
  }
  return canvas.finish();
}

}  // namespace nadir
