// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "nadir/report/map_view.hpp"

namespace nadir::report {

// Shared measures of all figures, pixels.
inline constexpr double kMargin = 44.0;
inline constexpr double kTitleHeight = 66.0;
inline constexpr double kTickRoom = 40.0;  ///< below a map, for its tick labels
inline constexpr double kCaption = 44.0;   ///< above a small picture, for its caption

/// Room left of a map for its tick labels, which may be as long as UTM northings.
double tick_room(const Region& region);

/// One line of a legend: a sample is drawn at the left of the text.
struct LegendEntry {
  std::string name;
  std::string detail;  ///< a second, muted line; may be empty
  std::function<void(Canvas&, const Box&)> sample;
};

/// Draws the entries column by column or, in a wide box, row by row.
void draw_legend(Canvas& canvas, const Box& box, const std::vector<LegendEntry>& entries);

/// Height that `draw_legend` needs in a box of this width.
double legend_height(double width, std::size_t entries);

void draw_title(Canvas& canvas, const std::string& title);

/// A note in the middle of an empty box: what there is nothing of.
void draw_note(Canvas& canvas, const Box& box, const std::string& note);

/// A figure of one map with a panel for the legend: beside a tall map, below a wide one.
struct MapLayout {
  int width = 0;
  int height = 0;
  MapView view;
  Box legend;
  Box furniture;  ///< scale bar and north arrow
};
MapLayout lay_out_map(const Region& region, std::size_t legend_entries);

/// The part of the map that shows all of `content` with a margin: not too slim to be read, and not
/// beyond the map where that can be helped.
Region region_of_interest(const Region& content, const Region& map, double margin);

void draw_furniture(Canvas& canvas, const MapView& view, const Box& box, bool north_arrow = true);

}  // namespace nadir::report
