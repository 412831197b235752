// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/patches.hpp"

#include <algorithm>

namespace nadir::report {
namespace {

/// A cut-out of `source` upright in the robot's frame: what the local map covers.
/// `source_from_robot` takes robot coordinates to those of the source's geo-reference.
template <class To>
Imagery seen_from(const Transform2<To, frames::Robot>& source_from_robot, const Orthomosaic& source,
                  const Orthomosaic& local, int width, int height) {
  const double right = local.geo.resolution * local.width() / width;
  const double down = local.geo.resolution * local.height() / height;
  const auto pixel = [&](double u, double v) {
    const auto point = source_from_robot * Point2<frames::Robot>{local.geo.west + u * right,
                                                                 local.geo.north - v * down};
    return source.geo.pixel_at(point.x, point.y);
  };
  const PixelCoordinate origin = pixel(0.0, 0.0);
  const PixelCoordinate east = pixel(1.0, 0.0);
  const PixelCoordinate south = pixel(0.0, 1.0);
  return resample(source,
                  {east.column - origin.column, south.column - origin.column, origin.column,
                   east.row - origin.row, south.row - origin.row, origin.row},
                  width, height);
}

/// Squares of the one and of the other in turn.
Imagery checkerboard(const Imagery& one, const Imagery& other) {
  constexpr int kSquares = 6;
  Imagery mixed = one;
  const int side = std::max(1, std::max(mixed.colour.width(), mixed.colour.height()) / kSquares);
  for (int row = 0; row < mixed.colour.height(); ++row) {
    for (int column = 0; column < mixed.colour.width(); ++column) {
      if ((row / side + column / side) % 2 == 0) continue;
      for (int channel = 0; channel < 3; ++channel) {
        mixed.colour.at(column, row, channel) = other.colour.at(column, row, channel);
      }
      mixed.opacity.at(column, row) = other.opacity.at(column, row);
    }
  }
  return mixed;
}

}  // namespace

Patches patches_of(const Orthomosaic& map, const Orthomosaic& local, const Pose2& map_from_robot,
                   double side) {
  const double scale = side / std::max(local.width(), local.height());
  const int width = std::max(1, fine_pixels(scale * local.width()));
  const int height = std::max(1, fine_pixels(scale * local.height()));
  const Transform2<frames::Robot, frames::Robot> as_it_is;
  Patches patches{seen_from(as_it_is, local, local, width, height), {}, {}};
  if (!map_from_robot.is_finite()) return patches;
  patches.map = seen_from(map_from_robot, map, local, width, height);
  patches.both = checkerboard(*patches.map, patches.local);
  return patches;
}

void draw_patch(Canvas& canvas, const Box& box, const Imagery& imagery, const char* caption) {
  const Box frame{box.left, box.top,
                  static_cast<double>(imagery.colour.width()) / Canvas::kOversampling,
                  static_cast<double>(imagery.colour.height()) / Canvas::kOversampling};
  draw_hatching(canvas, frame);
  canvas.image(frame, imagery.colour, imagery.opacity);
  canvas.outline(frame.corners(), {kFrame, 1.5, {}, 0.0});
  canvas.fitted_text({box.left, box.top - 20.0}, caption, box.width,
                     {22.0, kInk, Align::kLeft, false, {}});
}

}  // namespace nadir::report
