// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/report/axes.hpp"
#include "nadir/report/charts.hpp"
#include "nadir/report/svg_sheet.hpp"
#include "nadir/report/ticks.hpp"

namespace nadir {
namespace {

using namespace report;

// Small, so that its text is still read on a phone.
constexpr double kSvgPlotHeight = 120.0;
constexpr double kSvgHeader = 30.0;    ///< above each plot: its label and legend
constexpr double kSvgAxisRoom = 48.0;  ///< left of the plots: tick labels
constexpr double kRightRoom = 14.0;    ///< half a tick label
constexpr double kFinest = 0.5;        ///< what lies closer together is drawn as its extent

std::string point(Position at) { return svg_number(at.x) + " " + svg_number(at.y); }

/// The points of one run. Of more than a few in one column the first, the lowest, the highest and
/// the last say all that can be seen.
std::vector<Position> thinned(const std::vector<Position>& points) {
  std::vector<Position> kept;
  for (std::size_t i = 0; i < points.size();) {
    std::size_t end = i;
    while (end < points.size() && std::abs(points[end].x - points[i].x) < kFinest) ++end;
    if (end - i <= 4) {
      kept.insert(kept.end(), points.begin() + static_cast<std::ptrdiff_t>(i),
                  points.begin() + static_cast<std::ptrdiff_t>(end));
    } else {
      const auto [high, low] = std::minmax_element(
          points.begin() + static_cast<std::ptrdiff_t>(i),
          points.begin() + static_cast<std::ptrdiff_t>(end),
          [](const Position& one, const Position& other) { return one.y < other.y; });
      kept.insert(kept.end(), {points[i], *high, *low, points[end - 1]});
    }
    i = end;
  }
  return kept;
}

std::string polyline(const std::vector<Position>& points) {
  std::string data;
  for (const Position& at : thinned(points)) data += (data.empty() ? "M" : " L") + point(at);
  return data;
}

/// A line for each run without a gap, and a dot where a value stands alone.
void draw_curve(SvgSheet& sheet, const Plot& plot, const Curve& curve, std::size_t index) {
  for (const auto& [first, last] : whole_runs(curve)) {
    std::vector<Position> points;
    for (std::size_t i = first; i < last; ++i) points.push_back(plot.at(curve.x[i], curve.y[i]));
    if (points.size() == 1) {
      sheet.disc(points.front(), 2.5, "dot " + curve_class(index));
    } else {
      sheet.path(polyline(points), "curve " + curve_class(index));
    }
  }
}

void draw_band(SvgSheet& sheet, const Plot& plot, const Band& band) {
  for (const auto& [first, last] : whole_runs(band)) {
    std::vector<Position> upper;
    std::vector<Position> lower;
    for (std::size_t i = first; i < last; ++i) upper.push_back(plot.at(band.x[i], band.high[i]));
    for (std::size_t i = last; i-- > first;) lower.push_back(plot.at(band.x[i], band.low[i]));
    std::string data = polyline(upper);
    for (const Position& at : thinned(lower)) data += " L" + point(at);
    sheet.path(data + " Z", "band");
  }
}

void draw_grid(SvgSheet& sheet, const Plot& plot, double x_step, double y_step, bool x_labels) {
  for (const double x : ticks_between(plot.x.low, plot.x.high, x_step)) {
    const Position foot = plot.at(x, plot.y.low);
    sheet.line({foot.x, plot.box.top}, foot, "grid");
    if (x_labels) sheet.text({foot.x, foot.y + 15.0}, tick_label(x, x_step), "middle", "muted");
  }
  for (const double y : ticks_between(plot.y.low, plot.y.high, y_step)) {
    const Position left = plot.at(plot.x.low, y);
    sheet.line(left, {plot.box.right(), left.y}, "grid");
    sheet.text({left.x - 6.0, left.y + 4.0}, tick_label(y, y_step), "end", "muted");
  }
  const Position origin{plot.box.left, plot.box.bottom()};
  sheet.line({plot.box.left, plot.box.top}, origin, "frame");
  sheet.line(origin, {plot.box.right(), plot.box.bottom()}, "frame");
}

/// Names of curves and bands from the right end of the header leftwards.
void draw_keys(SvgSheet& sheet, const Panel& panel, const Box& header) {
  std::vector<Key> keys = keys_of(panel);
  std::ranges::reverse(keys);
  const double y = header.bottom() - 9.0;
  double right = header.right();
  for (const Key& key : keys) {
    const double text = right - svg_text_width(key.name);
    if (text - 24.0 < header.left + svg_text_width(panel.y_label)) return;
    sheet.text({text, y}, key.name, "start");
    if (key.is_band) {
      sheet.rectangle({text - 22.0, y - 9.0, 17.0, 9.0}, "band");
    } else {
      sheet.line({text - 22.0, y - 4.0}, {text - 5.0, y - 4.0}, "curve " + curve_class(key.index));
    }
    right = text - 34.0;
  }
}

void draw_panel(SvgSheet& sheet, const Panel& panel, const Box& box, const Interval& x,
                double x_step, bool last) {
  double y_step = 1.0;
  const Interval y = y_interval(panel, y_step);
  const Plot plot{{box.left, box.top + kSvgHeader, box.width, box.height - kSvgHeader}, x, y};
  draw_grid(sheet, plot, x_step, y_step, last);
  for (const Band& band : panel.bands) draw_band(sheet, plot, band);
  for (std::size_t i = panel.curves.size(); i-- > 0;) draw_curve(sheet, plot, panel.curves[i], i);
  if (y.empty) sheet.text(plot.box.centre(), "no values", "middle", "muted");
  const Box header{box.left - kSvgAxisRoom + 6.0, box.top, box.width + kSvgAxisRoom - 6.0,
                   kSvgHeader};
  sheet.text({header.left, header.bottom() - 9.0}, panel.y_label, "start", "bold");
  draw_keys(sheet, panel, header);
}

}  // namespace

std::string svg_panels(const std::vector<Panel>& panels, const std::string& x_label,
                       const std::string& title) {
  const double panel_height = kSvgHeader + kSvgPlotHeight;
  const double height = panel_height * static_cast<double>(std::max<std::size_t>(1, panels.size()));
  SvgSheet sheet(kSvgWidth, height + kSvgBelowAll, title);
  const Interval x = x_interval(panels);
  const double x_step = nice_step(x.high - x.low, 8);
  const double width = kSvgWidth - kSvgAxisRoom - kRightRoom;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Box box{kSvgAxisRoom, panel_height * static_cast<double>(i), width, panel_height};
    draw_panel(sheet, panels[i], box, x, x_step, i + 1 == panels.size());
  }
  if (panels.empty()) {
    sheet.text({0.5 * kSvgWidth, 0.5 * height}, "nothing to show", "middle", "muted");
  }
  sheet.text({kSvgAxisRoom + 0.5 * width, height + 34.0}, x_label, "middle");
  return sheet.finish();
}

}  // namespace nadir
