// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "nadir/report/figures.hpp"
#include "nadir/report/map_figure.hpp"

namespace nadir {
namespace {

using namespace report;

/// Tracks beneath are drawn wider, so that they show where the upper ones cover them.
double line_width(std::size_t index) {
  return 3.4 + 3.8 * std::min(static_cast<double>(index), 3.0);
}
double dot_radius(std::size_t index) { return 0.75 * line_width(index) + 1.6; }

constexpr double kDotSpacing = 20.0;  ///< pixels between two dots at least

double length_of(const Trajectory& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    const double step = std::hypot(trajectory[i].pose.x - trajectory[i - 1].pose.x,
                                   trajectory[i].pose.y - trajectory[i - 1].pose.y);
    if (std::isfinite(step)) length += step;
  }
  return length;
}

void draw_dot(Canvas& canvas, Position at, std::size_t index) {
  canvas.disc(at, dot_radius(index) + 1.6, kInk);
  canvas.disc(at, dot_radius(index), track_colour(index));
}

void draw_start(Canvas& canvas, Position at, Colour colour) {
  canvas.disc(at, 12.0, kInk);
  canvas.disc(at, 10.5, kPaper);
  canvas.disc(at, 6.5, colour);
}

void draw_end(Canvas& canvas, Position at, Colour colour) {
  const auto square = [at](double half) {
    return Box{at.x - half, at.y - half, 2.0 * half, 2.0 * half}.corners();
  };
  canvas.fill(square(11.0), kInk);
  canvas.fill(square(9.5), kPaper);
  canvas.fill(square(6.0), colour);
}

void draw_track(Canvas& canvas, const MapView& view, const Trajectory& trajectory,
                std::size_t index) {
  std::vector<Position> points;
  for (const auto& stamped : trajectory) {
    points.push_back(view.at(stamped.pose.x, stamped.pose.y));
  }
  canvas.line(points, {track_colour(index), line_width(index), kInk, 0.0});
  std::erase_if(points, [](Position p) { return !std::isfinite(p.x) || !std::isfinite(p.y); });
  if (points.empty()) return;
  Position last = points.front();
  for (const Position& point : points) {
    if (std::hypot(point.x - last.x, point.y - last.y) < kDotSpacing) continue;
    draw_dot(canvas, point, index);
    last = point;
  }
  draw_start(canvas, points.front(), track_colour(index));
  draw_end(canvas, points.back(), track_colour(index));
}

std::vector<LegendEntry> legend_of(const std::vector<Track>& tracks) {
  std::vector<LegendEntry> entries;
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    std::array<char, 64> detail{};
    std::snprintf(detail.data(), detail.size(), "%zu poses, %.1f m", tracks[i].trajectory.size(),
                  length_of(tracks[i].trajectory));
    entries.push_back({tracks[i].name, detail.data(), [i](Canvas& canvas, const Box& box) {
                         const Position middle = box.centre();
                         canvas.line({{box.left + 3.0, middle.y}, {box.right() - 3.0, middle.y}},
                                     {track_colour(i), line_width(i), kInk, 0.0});
                         draw_dot(canvas, middle, i);
                       }});
  }
  return entries;
}

void add_end_marks(std::vector<LegendEntry>& entries) {
  entries.push_back({"start", "", [](Canvas& canvas, const Box& box) {
                       draw_start(canvas, box.centre(), kMuted);
                     }});
  entries.push_back(
      {"end", "", [](Canvas& canvas, const Box& box) { draw_end(canvas, box.centre(), kMuted); }});
}

Region content_of(const std::vector<Track>& tracks) {
  Region content;
  for (const Track& track : tracks) {
    for (const auto& stamped : track.trajectory) content.include(stamped.pose.x, stamped.pose.y);
  }
  return content;
}

}  // namespace

Figure draw_trajectories(const Orthomosaic& map, const std::vector<Track>& tracks,
                         const std::string& title, const Surroundings& surroundings) {
  constexpr double kMarginM = 5.0;
  const Region content = content_of(tracks);
  const Region extent = extent_of(map.geo, map.width(), map.height());
  std::vector<LegendEntry> legend = legend_of(tracks);
  if (!content.empty) add_end_marks(legend);
  const MapLayout layout =
      lay_out_map(region_of_interest(surroundings.whole_map ? extent : content, extent, kMarginM),
                  legend.size());
  Canvas canvas(layout.width, layout.height);
  draw_title(canvas, title);
  draw_map(canvas, layout.view, map, Tint::kColour);
  canvas.clip(layout.view.box);
  for (std::size_t i = tracks.size(); i-- > 0;) {
    draw_track(canvas, layout.view, tracks[i].trajectory, i);
  }
  canvas.unclip();
  if (content.empty) draw_note(canvas, layout.view.box, "nothing to show: no pose in any track");
  draw_map_axes(canvas, layout.view);
  draw_legend(canvas, layout.legend, legend);
  draw_furniture(canvas, layout.view, layout.furniture, surroundings.north_arrow);
  return canvas.finish();
}

}  // namespace nadir
