// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/imagery.hpp"
#include "nadir/report/map_figure.hpp"

namespace nadir {
namespace {

using namespace report;

constexpr int kSheetWidth = 1900;
constexpr int kSheetHeight = 1250;
constexpr double kRight = 1090.0;  ///< where the right column starts

/// The figure's x axes and y axes.
constexpr Colour kAxisX = kVermillion;
constexpr Colour kAxisY = kGreen;

const TextStyle kHeading{26.0, kInk, Align::kLeft, true, {}};
const TextStyle kNormal{22.0, kInk, Align::kLeft, false, {}};
const TextStyle kSmall{20.0, kMuted, Align::kLeft, false, {}};

/// `distance` pixels from `from` in a direction, radians counter-clockwise from the right.
Position ahead(Position from, double direction, double distance) {
  return {from.x + distance * std::cos(direction), from.y - distance * std::sin(direction)};
}

TextStyle in(TextStyle style, Colour colour, Align align = Align::kLeft) {
  style.colour = colour;
  style.align = align;
  return style;
}

/// The two axes of a frame, with their names beyond their tips.
void draw_axes(Canvas& canvas, Position origin, double yaw, double length, const char* x_name,
               const char* y_name) {
  const double up = yaw + 0.5 * kPi;
  canvas.arrow(origin, ahead(origin, yaw, length), {kAxisX, 5.0, kPaper, 0.0});
  canvas.arrow(origin, ahead(origin, up, length), {kAxisY, 5.0, kPaper, 0.0});
  canvas.disc(origin, 9.0, kInk);
  const Position x_text = ahead(origin, yaw, length + 14.0);
  const Position y_text = ahead(origin, up, length + 24.0);
  canvas.text({x_text.x, x_text.y}, x_name, in(kNormal, kAxisX));
  canvas.text({y_text.x, y_text.y}, y_name, in(kNormal, kAxisY, Align::kCentre));
}

void draw_robot(Canvas& canvas, Position at, double yaw, double size) {
  const auto corner = [&](double forward, double left) {
    return ahead(ahead(at, yaw, forward * size), yaw + 0.5 * kPi, left * size);
  };
  for (const double side : {-0.40, 0.40}) {
    for (const double axle : {-0.45, 0.45}) {
      canvas.fill({corner(axle - 0.2, side - 0.1), corner(axle + 0.2, side - 0.1),
                   corner(axle + 0.2, side + 0.1), corner(axle - 0.2, side + 0.1)},
                  kInk);
    }
  }
  const std::vector<Position> body{corner(-0.7, -0.36), corner(0.55, -0.36), corner(0.78, -0.18),
                                   corner(0.78, 0.18),  corner(0.55, 0.36),  corner(-0.7, 0.36)};
  canvas.fill(body, {205, 221, 235});
  canvas.outline(body, {kInk, 2.5, {}, 0.0});
}

/// An arrow from frame to frame that bows to its left.
struct Bow {
  Position from;
  Position to;
  double lift = 0.0;   ///< pixels
  double clear = 0.0;  ///< pixels kept free before `to`

  Position at(double t) const {
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double raised = 4.0 * t * (1.0 - t) * lift / length;
    return {from.x + t * (to.x - from.x) + raised * (to.y - from.y),
            from.y + t * (to.y - from.y) - raised * (to.x - from.x)};
  }
};

void draw_bow(Canvas& canvas, const Bow& bow) {
  constexpr double kClear = 26.0;
  constexpr int kPieces = 40;
  const double length = std::hypot(bow.to.x - bow.from.x, bow.to.y - bow.from.y);
  const double start = kClear / length;
  const double end = 1.0 - bow.clear / length;
  std::vector<Position> points;
  for (int i = 0; i <= kPieces; ++i) points.push_back(bow.at(start + (end - start) * i / kPieces));
  const Stroke stroke{kMuted, 3.5, {}, 0.0};
  const Position tip = points.back();
  const Position neck = points[points.size() - 4];
  points.resize(points.size() - 2);
  canvas.line(points, stroke);
  canvas.arrow(neck, tip, stroke);
}

void draw_yaw(Canvas& canvas, Position at, double yaw) {
  constexpr double kRadius = 118.0;
  canvas.line({at, ahead(at, 0.0, 205.0)}, {kFrame, 2.0, {}, 9.0});
  std::vector<Position> arc;
  constexpr int kPieces = 30;
  for (int i = 0; i <= kPieces; ++i) arc.push_back(ahead(at, 0.93 * yaw * i / kPieces, kRadius));
  canvas.line(arc, {kBlue, 3.5, {}, 0.0});
  canvas.arrow(ahead(at, 0.82 * yaw, kRadius), ahead(at, yaw, kRadius), {kBlue, 3.5, {}, 0.0});
  canvas.text(ahead(at, 0.5 * yaw, kRadius + 16.0), "yaw", in(kNormal, kBlue));
  canvas.text(ahead(at, 0.0, 213.0), "east", kSmall);
}

/// The three frames and the transforms between them.
void draw_frames(Canvas& canvas) {
  canvas.text({kMargin, 142.0}, "Frames", kHeading);
  const Position map{170.0, 930.0};
  const Position odom{430.0, 640.0};
  const Position robot{720.0, 400.0};
  const double yaw = radians(38.0);
  const Bow map_from_odom{map, odom, 70.0, 30.0};
  const Bow odom_from_robot{odom, robot, 70.0, 84.0};
  const Bow map_from_robot{map, robot, -150.0, 84.0};
  for (const Bow& bow : {map_from_odom, odom_from_robot, map_from_robot}) draw_bow(canvas, bow);
  draw_yaw(canvas, robot, yaw);
  draw_robot(canvas, robot, yaw, 66.0);
  draw_axes(canvas, map, 0.0, 150.0, "x, east", "y, north");
  draw_axes(canvas, odom, radians(14.0), 120.0, "x", "y");
  draw_axes(canvas, robot, yaw, 165.0, "x, forward", "y, left");
  canvas.text({map.x - 10.0, map.y + 40.0}, "map", kHeading);
  canvas.text({odom.x - 10.0, odom.y + 40.0}, "odom", kHeading);
  canvas.text({robot.x + 44.0, robot.y + 84.0}, "robot", kHeading);
  const auto beside = [&](Position at, const char* name, double shift, Align align) {
    canvas.text({at.x + shift, at.y}, name, in(kNormal, kInk, align));
  };
  beside(map_from_odom.at(0.7), "map_from_odom", -34.0, Align::kRight);
  beside(odom_from_robot.at(0.62), "odom_from_robot", -34.0, Align::kRight);
  beside(map_from_robot.at(0.5), "map_from_robot", 20.0, Align::kLeft);
}

void draw_frames_note(Canvas& canvas) {
  const Box box{kMargin, 1050.0, 960.0, 150.0};
  canvas.fill(box.corners(), {244, 246, 248});
  canvas.text({box.left + 24.0, box.top + 36.0}, "map_from_robot = map_from_odom * odom_from_robot",
              {25.0, kInk, {}, true, {}});
  canvas.text({box.left + 24.0, box.top + 78.0},
              "p_in_map = map_from_robot * p_in_robot: neighbours cancel.", kNormal);
  canvas.text({box.left + 24.0, box.top + 114.0},
              "Metres and radians; yaw counter-clockwise from east, in (-pi, pi].", kNormal);
}

constexpr int kColumns = 6;
constexpr int kRows = 4;
constexpr double kCell = 74.0;

void draw_cells(Canvas& canvas, const Box& grid) {
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const Box cell{grid.left + kCell * column, grid.top + kCell * row, kCell, kCell};
      const bool invalid = (column == 4 && row == 3) || (column == 5 && row >= 2);
      if (invalid) {
        draw_hatching(canvas, cell);
      } else {
        const auto grey = static_cast<std::uint8_t>(196 + (column * 37 + row * 53) % 41);
        canvas.fill(cell.corners(), {grey, grey, grey});
      }
      canvas.outline(cell.corners(), {kPaper, 2.0, {}, 0.0});
    }
  }
  canvas.outline(grid.corners(), {kInk, 2.5, {}, 0.0});
}

void draw_grid_marks(Canvas& canvas, const Box& grid) {
  const Position corner{grid.left, grid.top};
  const Position centre{grid.left + 0.5 * kCell, grid.top + 0.5 * kCell};
  canvas.arrow({grid.left, grid.top - 24.0}, {grid.left + 170.0, grid.top - 24.0},
               {kInk, 4.0, {}, 0.0});
  canvas.text({grid.left + 182.0, grid.top - 24.0}, "column", kNormal);
  canvas.arrow({grid.left - 24.0, grid.top}, {grid.left - 24.0, grid.top + 170.0},
               {kInk, 4.0, {}, 0.0});
  canvas.text({grid.left - 10.0, grid.top + 192.0}, "row", in(kNormal, kInk, Align::kRight));
  canvas.disc(corner, 10.0, kBlue);
  canvas.disc(centre, 7.0, kVermillion);
  const double right = grid.right() + 28.0;
  const double y = grid.top + 6.0;
  const auto entry = [&](double at, Colour colour, const char* name, const char* detail) {
    canvas.disc({right + 8.0, at}, 8.0, colour);
    canvas.text({right + 28.0, at}, name, kNormal);
    canvas.text({right + 28.0, at + 32.0}, detail, kSmall);
  };
  entry(y, kBlue, "(0, 0)", "outer corner:");
  canvas.text({right + 28.0, y + 60.0}, "west, north", kSmall);
  entry(y + 112.0, kVermillion, "(0.5, 0.5)", "centre of pixel 0, 0");
  draw_hatching(canvas, {right - 4.0, y + 196.0, 26.0, 26.0});
  canvas.outline(Box{right - 4.0, y + 196.0, 26.0, 26.0}.corners(), {kFrame, 1.5, {}, 0.0});
  canvas.text({right + 32.0, y + 209.0}, "not seen: mask 0", kNormal);
}

/// A raster of the map: where its pixels lie.
void draw_raster(Canvas& canvas) {
  canvas.text({kRight, 142.0}, "Rasters: row 0 is north", kHeading);
  const Box grid{kRight + 50.0, 218.0, kCell * kColumns, kCell * kRows};
  draw_cells(canvas, grid);
  draw_grid_marks(canvas, grid);
  canvas.text({grid.left, grid.bottom() + 36.0}, "x = west + column * resolution", kNormal);
  canvas.text({grid.left, grid.bottom() + 70.0}, "y = north - row * resolution", kNormal);
}

/// A local map: the robot's frame laid over the same kind of raster.
void draw_local_map(Canvas& canvas) {
  canvas.text({kRight, 672.0}, "Local maps: the robot's own frame", kHeading);
  const Box box{kRight + 50.0, 720.0, 400.0, 400.0};
  canvas.fill(box.corners(), {222, 224, 226});
  const Box hole{box.left + 255.0, box.top + 300.0, 145.0, 100.0};
  draw_hatching(canvas, hole);
  const Box corner{box.left, box.top, 90.0, 60.0};
  draw_hatching(canvas, corner);
  canvas.outline(box.corners(), {kInk, 2.5, {}, 0.0});
  const Position robot = box.centre();
  draw_robot(canvas, robot, 0.0, 56.0);
  draw_axes(canvas, robot, 0.0, 128.0, "x", "y");
  canvas.disc({box.left, box.top}, 10.0, kBlue);
  const double text = box.right() + 28.0;
  canvas.text({text, box.top + 14.0}, "robot at (0, 0)", kNormal);
  canvas.text({text, box.top + 50.0}, "x forward: right", in(kNormal, kAxisX));
  canvas.text({text, box.top + 86.0}, "y left: up", in(kNormal, kAxisY));
  canvas.text({text, box.top + 134.0}, "west, north of the", kSmall);
  canvas.text({text, box.top + 162.0}, "outer corner count", kSmall);
  canvas.text({text, box.top + 190.0}, "in the robot frame", kSmall);
}

}  // namespace

Figure draw_conventions() {
  Canvas canvas(kSheetWidth, kSheetHeight);
  draw_title(canvas, "Conventions: frames, angles, rasters");
  canvas.line({{kRight - 36.0, 130.0}, {kRight - 36.0, kSheetHeight - kMargin}},
              {kGrid, 2.0, {}, 0.0});
  draw_frames(canvas);
  draw_frames_note(canvas);
  draw_raster(canvas);
  draw_local_map(canvas);
  return canvas.finish();
}

}  // namespace nadir
