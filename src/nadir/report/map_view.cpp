// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/map_view.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/report/ticks.hpp"

namespace nadir::report {

void Region::include(double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  west = empty ? x : std::min(west, x);
  east = empty ? x : std::max(east, x);
  south = empty ? y : std::min(south, y);
  north = empty ? y : std::max(north, y);
  empty = false;
}

Region Region::grown(double margin) const {
  return {west - margin, south - margin, east + margin, north + margin, empty};
}

Region Region::at_least(double width, double height) const {
  const double across = std::max(0.0, 0.5 * (width - this->width()));
  const double up = std::max(0.0, 0.5 * (height - this->height()));
  return {west - across, south - up, east + across, north + up, empty};
}

Region Region::intersected(const Region& other) const {
  Region both{std::max(west, other.west), std::max(south, other.south), std::min(east, other.east),
              std::min(north, other.north), empty || other.empty};
  if (both.width() <= 0.0 || both.height() <= 0.0) both.empty = true;
  return both;
}

Region extent_of(const GeoReference& geo, int width, int height) {
  if (width <= 0 || height <= 0) return {};
  return {geo.west, geo.y_at(height), geo.x_at(width), geo.north, false};
}

MapView fit(const Region& region, const Box& available) {
  const double scale =
      std::min(available.width / region.width(), available.height / region.height());
  return {region, {available.left, available.top, scale * region.width(), scale * region.height()}};
}

void draw_map_axes(Canvas& canvas, const MapView& view, double text_size) {
  const Box& box = view.box;
  const TextStyle below{text_size, kMuted, Align::kCentre, false, {}};
  const TextStyle left{text_size, kMuted, Align::kRight, false, {}};
  const auto most = [](double length, double room) {
    return std::max(1, static_cast<int>(length / room));
  };
  const double step = std::max(nice_step(view.region.width(), most(box.width, 6.5 * text_size)),
                               nice_step(view.region.height(), most(box.height, 5.0 * text_size)));
  for (const double x : ticks_between(view.region.west, view.region.east, step)) {
    const double at = view.at(x, view.region.south).x;
    canvas.line({{at, box.bottom()}, {at, box.bottom() + 7.0}}, {kFrame, 1.5, {}, 0.0});
    const std::string label = tick_label(x, step);
    if (at - 0.5 * text_width(label, below) < box.left) continue;  // the unit stands there
    canvas.text({at, box.bottom() + 12.0 + 0.6 * text_size}, label, below);
  }
  for (const double y : ticks_between(view.region.south, view.region.north, step)) {
    const double at = view.at(view.region.west, y).y;
    canvas.line({{box.left - 7.0, at}, {box.left, at}}, {kFrame, 1.5, {}, 0.0});
    canvas.text({box.left - 13.0, at}, tick_label(y, step), left);
  }
  canvas.text({box.left - 13.0, box.bottom() + 12.0 + 0.6 * text_size}, "m", left);
  canvas.outline(box.corners(), {kFrame, 1.5, {}, 0.0});
}

void draw_scale_bar(Canvas& canvas, const MapView& view, Position position, double longest,
                    bool on_imagery) {
  const double metres = round_down(longest / view.pixels_per_metre());
  const double length = metres * view.pixels_per_metre();
  const double size = on_imagery ? 18.0 : 21.0;
  const double y = position.y + size + 6.0;
  const auto piece = [&](double from, double to, Colour colour) {
    canvas.fill(Box{position.x + from * length, y, (to - from) * length, 8.0}.corners(), colour);
  };
  canvas.fill(Box{position.x - 2.0, y - 2.0, length + 4.0, 12.0}.corners(),
              on_imagery ? kPaper : kInk);
  canvas.fill(Box{position.x, y, length, 8.0}.corners(), kPaper);
  piece(0.0, 0.25, kInk);
  piece(0.5, 0.75, kInk);
  if (on_imagery) piece(0.0, 1.0, kInk);
  TextStyle style{size, kInk, Align::kLeft, false, {}};
  if (on_imagery) style.halo = kPaper;
  canvas.text({position.x, position.y + 0.5 * size}, tick_label(metres, metres) + " m", style);
}

void draw_north_arrow(Canvas& canvas, Position top, double height) {
  const double half = 0.22 * height;
  const double foot = top.y + 0.72 * height;
  const Position notch{top.x, top.y + 0.56 * height};
  canvas.fill({top, {top.x - half, foot}, notch}, kInk);
  canvas.fill({top, {top.x + half, foot}, notch}, kPaper);
  canvas.outline({top, {top.x - half, foot}, notch, {top.x + half, foot}}, {kInk, 1.5, {}, 0.0});
  canvas.text({top.x, top.y + 0.9 * height}, "N", {0.3 * height, kInk, Align::kCentre, true, {}});
}

std::vector<Point2<frames::Map>> outline_of(const Pose2& map_from_robot, const GeoReference& geo,
                                            int width, int height) {
  const double west = geo.west;
  const double east = geo.x_at(width);
  const double north = geo.north;
  const double south = geo.y_at(height);
  using InRobot = Point2<frames::Robot>;
  return {map_from_robot * InRobot{east, north}, map_from_robot * InRobot{east, south},
          map_from_robot * InRobot{west, south}, map_from_robot * InRobot{west, north}};
}

}  // namespace nadir::report
