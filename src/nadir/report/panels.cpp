// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "nadir/report/axes.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/map_figure.hpp"
#include "nadir/report/ticks.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr int kPanelsWidth = 1640;
constexpr double kPlotHeight = 250.0;
constexpr double kHeader = 58.0;    ///< above each plot: its label and legend
constexpr double kAxisRoom = 96.0;  ///< left of the plots: tick labels
constexpr double kBelowAll = 84.0;  ///< below the last plot: tick labels and the x label
constexpr double kTextSize = 19.0;

void draw_grid(Canvas& canvas, const Plot& plot, double x_step, double y_step, bool x_labels) {
  const Stroke grid{kGrid, 1.5, {}, 0.0};
  for (const double x : ticks_between(plot.x.low, plot.x.high, x_step)) {
    const double at = plot.at(x, plot.y.low).x;
    canvas.line({{at, plot.box.top}, {at, plot.box.bottom()}}, grid);
    if (x_labels) {
      canvas.text({at, plot.box.bottom() + 24.0}, tick_label(x, x_step),
                  {kTextSize, kMuted, Align::kCentre, false, {}});
    }
  }
  for (const double y : ticks_between(plot.y.low, plot.y.high, y_step)) {
    const double at = plot.at(plot.x.low, y).y;
    canvas.line({{plot.box.left, at}, {plot.box.right(), at}}, grid);
    canvas.text({plot.box.left - 14.0, at}, tick_label(y, y_step),
                {kTextSize, kMuted, Align::kRight, false, {}});
  }
  canvas.line({{plot.box.left, plot.box.top},
               {plot.box.left, plot.box.bottom()},
               {plot.box.right(), plot.box.bottom()}},
              {kFrame, 1.8, {}, 0.0});
}

/// Filled between its bounds; a missing bound leaves a gap.
void draw_band(Canvas& canvas, const Plot& plot, const Band& band) {
  for (const auto& [first, last] : whole_runs(band)) {
    std::vector<Position> outline;
    for (std::size_t i = first; i < last; ++i) outline.push_back(plot.at(band.x[i], band.high[i]));
    for (std::size_t i = last; i-- > first;) outline.push_back(plot.at(band.x[i], band.low[i]));
    canvas.fill(outline, kBandColour, kBandOpacity);
  }
}

/// The curve, and a dot where a value stands alone between gaps.
void draw_curve(Canvas& canvas, const Plot& plot, const Curve& curve, Colour colour) {
  std::vector<Position> points;
  for (std::size_t i = 0; i < length_of(curve); ++i) {
    points.push_back(plot.at(curve.x[i], curve.y[i]));
  }
  const auto drawn = [&](std::size_t i) {
    return i < points.size() && std::isfinite(points[i].x) && std::isfinite(points[i].y);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool alone = drawn(i) && !drawn(i + 1) && (i == 0 || !drawn(i - 1));
    if (alone) canvas.disc(points[i], 4.0, colour);
  }
  canvas.line(points, {colour, 2.8, {}, 0.0});
}

/// Names of curves and bands from the right end of the header leftwards.
void draw_names(Canvas& canvas, const Panel& panel, const Box& header) {
  const TextStyle style{20.0, kInk, Align::kLeft, false, {}};
  double right = header.right();
  std::vector<Key> keys = keys_of(panel);
  std::ranges::reverse(keys);
  for (const Key& key : keys) {
    const double width = text_width(key.name, style);
    const double text = right - width;
    const double y = header.centre().y + 6.0;
    if (text - 52.0 < header.left + 0.35 * header.width) return;  // the panel's own label is there
    canvas.text({text, y}, key.name, style);
    if (key.is_band) {
      canvas.fill(Box{text - 46.0, y - 8.0, 34.0, 16.0}.corners(), kBandColour, kBandOpacity);
    } else {
      canvas.line({{text - 46.0, y}, {text - 12.0, y}}, {curve_colour(key.index), 4.0, {}, 0.0});
    }
    right = text - 46.0 - 30.0;
  }
}

void draw_panel(Canvas& canvas, const Panel& panel, const Box& box, const Interval& x,
                double x_step, bool last) {
  double y_step = 1.0;
  const Interval y = y_interval(panel, y_step);
  const Plot plot{{box.left, box.top + kHeader, box.width, box.height - kHeader}, x, y};
  draw_grid(canvas, plot, x_step, y_step, last);
  canvas.clip(plot.box.inset(-3.0));
  for (const Band& band : panel.bands) draw_band(canvas, plot, band);
  for (std::size_t i = panel.curves.size(); i-- > 0;) {
    draw_curve(canvas, plot, panel.curves[i], curve_colour(i));
  }
  canvas.unclip();
  if (y.empty) draw_note(canvas, plot.box, "no values");
  const Box header{box.left, box.top, box.width, kHeader};
  canvas.fitted_text({header.left, header.centre().y + 6.0}, panel.y_label, 0.34 * header.width,
                     {23.0, kInk, Align::kLeft, true, {}});
  draw_names(canvas, panel, header);
}

}  // namespace

Figure draw_panels(const std::vector<Panel>& panels, const std::string& x_label,
                   const std::string& title) {
  const double panel_height = kHeader + kPlotHeight;
  const double count = std::max(1.0, static_cast<double>(panels.size()));
  const double top = kMargin + kTitleHeight - 20.0;
  Canvas canvas(kPanelsWidth, static_cast<int>(top + count * panel_height + kBelowAll + 20.0));
  draw_title(canvas, title);
  const Interval x = x_interval(panels);
  const double x_step = nice_step(x.high - x.low, 12);
  const double left = kMargin + kAxisRoom;
  const double width = kPanelsWidth - left - kMargin - 10.0;
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Box box{left, top + panel_height * static_cast<double>(i), width, panel_height};
    draw_panel(canvas, panels[i], box, x, x_step, i + 1 == panels.size());
  }
  const double bottom = top + count * panel_height;
  if (panels.empty()) draw_note(canvas, {left, top, width, panel_height}, "nothing to show");
  canvas.text({left + 0.5 * width, bottom + 62.0}, x_label,
              {22.0, kInk, Align::kCentre, false, {}});
  return canvas.finish();
}

}  // namespace nadir
