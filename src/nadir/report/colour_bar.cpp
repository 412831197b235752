// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/colour_bar.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/report/ticks.hpp"

namespace nadir::report {
namespace {

constexpr double kBarTextSize = 18.0;
const TextStyle kBelow{kBarTextSize, kMuted, Align::kCentre, false, {}};
const TextStyle kBeside{kBarTextSize, kMuted, Align::kLeft, false, {}};

void draw_gradient(Canvas& canvas, const Box& box, ColourMap map) {
  const bool upright = box.height > box.width;
  const double length = upright ? box.height : box.width;
  const int strips = static_cast<int>(std::ceil(length));
  for (int strip = 0; strip < strips; ++strip) {
    const double at = strip;
    const Colour colour = mapped_colour(map, (at + 0.5) / length);
    const Box slice = upright ? Box{box.left, box.bottom() - at - 1.0, box.width, 1.5}
                              : Box{box.left + at, box.top, 1.5, box.height};
    canvas.fill(slice.corners(), colour);
  }
  canvas.outline(box.corners(), {kFrame, 1.5, {}, 0.0});
}

}  // namespace

void draw_colour_bar(Canvas& canvas, const Box& box, ColourMap map, const ColourScale& scale) {
  draw_gradient(canvas, box, map);
  const bool upright = box.height > box.width;
  const double span = scale.high > scale.low ? scale.high - scale.low : 1.0;
  const double step = nice_step(span, std::max(2, static_cast<int>(box.width + box.height) / 75));
  for (const double value : ticks_between(scale.low, scale.low + span, step)) {
    const double share = (value - scale.low) / span;
    if (upright) {
      const double y = box.bottom() - share * box.height;
      canvas.line({{box.right(), y}, {box.right() + 7.0, y}}, {kFrame, 1.5, {}, 0.0});
      canvas.text({box.right() + 13.0, y}, tick_label(value, step), kBeside);
    } else {
      const double x = box.left + share * box.width;
      canvas.line({{x, box.bottom()}, {x, box.bottom() + 6.0}}, {kFrame, 1.5, {}, 0.0});
      canvas.text({x, box.bottom() + 20.0}, tick_label(value, step), kBelow);
    }
  }
  if (upright) {
    canvas.text({box.left, box.top - 22.0}, scale.name, {21.0, kInk, Align::kLeft, false, {}});
  } else {
    canvas.text({box.right() + 26.0, box.centre().y}, scale.name,
                {21.0, kInk, Align::kLeft, false, {}});
  }
}

}  // namespace nadir::report
