// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/frames.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/trajectory.hpp"
#include "nadir/report/canvas.hpp"

namespace nadir::report {

/// An upright rectangle of the map, metres. Empty until something is included.
struct Region {
  double west = 0.0;
  double south = 0.0;
  double east = 0.0;
  double north = 0.0;
  bool empty = true;

  double width() const { return east - west; }
  double height() const { return north - south; }
  /// Points that are not finite are left out.
  void include(double x, double y);
  Region grown(double margin) const;
  /// At least `width` x `height` metres, about the same centre.
  Region at_least(double width, double height) const;
  Region intersected(const Region& other) const;
  bool operator==(const Region&) const = default;
};

/// The ground that a raster covers.
Region extent_of(const GeoReference& geo, int width, int height);

/// Where a region of the map lies in a figure, north up.
struct MapView {
  Region region;
  Box box;

  double pixels_per_metre() const { return box.width / region.width(); }
  Position at(double x, double y) const {
    return {box.left + (x - region.west) * pixels_per_metre(),
            box.top + (region.north - y) * pixels_per_metre()};
  }
  Position at(Point2<frames::Map> point) const { return at(point.x, point.y); }
};

/// The largest view of `region` that fits into `available`, in its upper left corner.
MapView fit(const Region& region, const Box& available);

enum class Tint { kColour, kGrey };

/// Draws the map over the view's box; hatching where there is no data.
void draw_map(Canvas& canvas, const MapView& view, const Orthomosaic& map, Tint tint);

/// Metre ticks and labels along the left and the lower edge, and a frame.
void draw_map_axes(Canvas& canvas, const MapView& view, double text_size = 19.0);

/// A bar of a round number of metres, at most `longest` pixels; its upper left corner at
/// `position`.
void draw_scale_bar(Canvas& canvas, const MapView& view, Position position, double longest,
                    bool on_imagery = false);

/// An arrow to the north, `height` pixels tall, with its N.
void draw_north_arrow(Canvas& canvas, Position top, double height);

/// The outline of a raster at a pose: its corners, clockwise from the robot's front left.
std::vector<Point2<frames::Map>> outline_of(const Pose2& map_from_robot, const GeoReference& geo,
                                            int width, int height);

}  // namespace nadir::report
