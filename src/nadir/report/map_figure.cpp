// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/map_figure.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/report/ticks.hpp"

namespace nadir::report {
namespace {

constexpr double kEntryWidth = 370.0;
constexpr double kEntryHeight = 66.0;
constexpr double kSampleWidth = 64.0;
constexpr double kFurnitureWidth = 420.0;
constexpr double kFurnitureHeight = 120.0;
constexpr double kLegendGap = 36.0;
constexpr double kSlimmest = 2.2;  ///< a longer map is widened, so that its surroundings show

int columns_in(double width) { return std::max(1, static_cast<int>(width / kEntryWidth)); }

MapLayout lay_out_tall(const Region& region, std::size_t entries) {
  constexpr double kMapHeight = 1500.0;
  constexpr double kPanelWidth = 430.0;
  const double left = kMargin + tick_room(region);
  MapLayout layout;
  layout.view = fit(region, {left, kMargin + kTitleHeight, 1500.0, kMapHeight});
  const Box& map = layout.view.box;
  layout.furniture = {map.right() + kLegendGap, map.bottom() - kFurnitureHeight, kPanelWidth,
                      kFurnitureHeight};
  layout.legend = {map.right() + kLegendGap, map.top, kPanelWidth,
                   legend_height(kPanelWidth, entries)};
  layout.width = static_cast<int>(map.right() + kLegendGap + kPanelWidth + kMargin);
  layout.height = static_cast<int>(map.bottom() + kTickRoom + kMargin);
  return layout;
}

MapLayout lay_out_wide(const Region& region, std::size_t entries) {
  constexpr double kMapWidth = 1680.0;
  const double left = kMargin + tick_room(region);
  MapLayout layout;
  layout.view = fit(region, {left, kMargin + kTitleHeight, kMapWidth, 1500.0});
  const Box& map = layout.view.box;
  const double top = map.bottom() + kTickRoom + 28.0;
  const double legend_width = map.width - kFurnitureWidth - kLegendGap;
  const double panel = std::max(kFurnitureHeight, legend_height(legend_width, entries));
  layout.legend = {map.left, top, legend_width, panel};
  layout.furniture = {map.right() - kFurnitureWidth, top, kFurnitureWidth, kFurnitureHeight};
  layout.width = static_cast<int>(map.right() + kMargin);
  layout.height = static_cast<int>(top + panel + kMargin - 10.0);
  return layout;
}

}  // namespace

double tick_room(const Region& region) {
  const double longest = std::max({std::abs(region.north), std::abs(region.south), 10.0});
  return 30.0 + 12.0 * std::ceil(std::log10(longest) + 1.0);
}

double legend_height(double width, std::size_t entries) {
  const auto columns = static_cast<std::size_t>(columns_in(width));
  const std::size_t rows = (entries + columns - 1) / columns;
  return kEntryHeight * static_cast<double>(rows);
}

void draw_legend(Canvas& canvas, const Box& box, const std::vector<LegendEntry>& entries) {
  const auto columns = static_cast<std::size_t>(columns_in(box.width));
  const double width = box.width / static_cast<double>(columns);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::size_t row = i / columns;
    const double left = box.left + width * static_cast<double>(i % columns);
    const double top = box.top + kEntryHeight * static_cast<double>(row);
    const double text = left + kSampleWidth + 18.0;
    const double room = width - kSampleWidth - 48.0;
    const bool two_lines = !entries[i].detail.empty();
    entries[i].sample(canvas, {left, top + 4.0, kSampleWidth, 36.0});
    canvas.fitted_text({text, top + 20.0}, entries[i].name, room, {24.0, kInk, {}, false, {}});
    if (two_lines) {
      canvas.fitted_text({text, top + 48.0}, entries[i].detail, room,
                         {18.0, kMuted, {}, false, {}});
    }
  }
}

void draw_title(Canvas& canvas, const std::string& title) {
  canvas.fitted_text({kMargin, kMargin + 12.0}, title, canvas.width() - 2.0 * kMargin,
                     {34.0, kInk, Align::kLeft, true, {}});
}

void draw_note(Canvas& canvas, const Box& box, const std::string& note) {
  const TextStyle style{26.0, kMuted, Align::kCentre, false, kPaper};
  canvas.fitted_text(box.centre(), note, box.width - 20.0, style);
}

MapLayout lay_out_map(const Region& region, std::size_t legend_entries) {
  return region.height() > 0.85 * region.width() ? lay_out_tall(region, legend_entries)
                                                 : lay_out_wide(region, legend_entries);
}

Region region_of_interest(const Region& content, const Region& map, double margin) {
  if (content.empty) return map.empty ? Region{0.0, 0.0, 10.0, 10.0, false} : map;
  const double longest = std::max(content.width(), content.height());
  Region wanted = content.grown(std::max(margin, 0.08 * longest));
  wanted = wanted.at_least(std::max(10.0, wanted.height() / kSlimmest),
                           std::max(10.0, wanted.width() / kSlimmest));
  // Not beyond the map, except where the content itself lies there.
  Region limit = map;
  limit.include(content.west - 1.0, content.south - 1.0);
  limit.include(content.east + 1.0, content.north + 1.0);
  const Region shown = wanted.intersected(limit);
  return shown.empty ? wanted : shown;
}

void draw_furniture(Canvas& canvas, const MapView& view, const Box& box, bool north_arrow) {
  if (north_arrow) draw_north_arrow(canvas, {box.right() - 36.0, box.top + 4.0}, 104.0);
  draw_scale_bar(canvas, view, {box.left + 4.0, box.top + 34.0}, box.width - 120.0);
}

}  // namespace nadir::report
