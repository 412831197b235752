// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/canvas.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/core/angle.hpp"

namespace nadir::report {
namespace {

constexpr int kSubpixelBits = 4;
constexpr double kHaloWidth = 1.2;  ///< on each side of a line

cv::Scalar scalar(Colour colour) {
  return {static_cast<double>(colour.red), static_cast<double>(colour.green),
          static_cast<double>(colour.blue)};
}

bool finite(Position p) { return std::isfinite(p.x) && std::isfinite(p.y); }

/// The part of the sheet inside a clip box, and where it starts.
struct View {
  cv::Mat pixels;
  cv::Point origin;

  View(Raster<std::uint8_t>& sheet, const Box& clip) {
    cv::Mat whole(sheet.height(), sheet.width(), CV_8UC3, sheet.values().data());
    const cv::Rect wanted(cvRound(kFine * clip.left), cvRound(kFine * clip.top),
                          cvRound(kFine * clip.width), cvRound(kFine * clip.height));
    const cv::Rect rect = wanted & cv::Rect(0, 0, whole.cols, whole.rows);
    pixels = whole(rect);
    origin = rect.tl();
  }

  /// Fixed-point coordinates; far outside is held near, so that they never overflow.
  cv::Point at(Position p) const {
    constexpr double kOne = 1U << kSubpixelBits;
    constexpr double kFar = 30000.0;
    const double x = std::clamp(kFine * p.x - origin.x - 0.5, -kFar, kFar);
    const double y = std::clamp(kFine * p.y - origin.y - 0.5, -kFar, kFar);
    return {cvRound(x * kOne), cvRound(y * kOne)};
  }
};

int fine_width(double width) { return std::max(1, cvRound(kFine * width)); }

/// Draws on a copy and mixes it in, where `opacity` asks for that.
template <class Draw>
void draw_with_opacity(cv::Mat pixels, cv::Rect touched, double opacity, const Draw& draw) {
  touched &= cv::Rect(0, 0, pixels.cols, pixels.rows);
  if (touched.empty() || opacity <= 0.0) return;
  if (opacity >= 1.0) {
    draw(pixels);
    return;
  }
  cv::Mat under = pixels(touched).clone();
  draw(pixels);
  cv::Mat over = pixels(touched);
  cv::addWeighted(over, opacity, under, 1.0 - opacity, 0.0, over);
}

/// The dashes of a line, each a short line of its own.
std::vector<std::vector<Position>> dashes_of(const std::vector<Position>& points, double dash) {
  std::vector<std::vector<Position>> dashes;
  double walked = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Position a = points[i - 1];
    const Position b = points[i];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!std::isfinite(length) || length <= 0.0) continue;
    for (double at = 0.0; at < length;) {
      const double phase = std::fmod(walked + at, 2.0 * dash);
      const double end = std::min(length, at + (phase < dash ? dash : 2.0 * dash) - phase + 1e-9);
      const auto point = [&](double distance) {
        const double t = distance / length;
        return Position{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
      };
      if (phase < dash) dashes.push_back({point(at), point(end)});
      at = end;
    }
    walked += length;
  }
  return dashes;
}

}  // namespace

int fine_pixels(double length) { return cvRound(kFine * length); }

Canvas::Canvas(int width, int height, Colour background)
    : sheet_(width * kOversampling, height * kOversampling, 0, 3),
      clip_{0.0, 0.0, static_cast<double>(width), static_cast<double>(height)} {
  View(sheet_, clip_).pixels.setTo(scalar(background));
}

void Canvas::clip(const Box& box) { clip_ = box; }

void Canvas::unclip() {
  clip_ = {0.0, 0.0, static_cast<double>(width()), static_cast<double>(height())};
}

void Canvas::plain_line(const std::vector<Position>& points, Colour colour, double width) {
  View view(sheet_, clip_);
  std::vector<cv::Point> run;
  const auto flush = [&] {
    if (run.size() > 1) {
      cv::polylines(view.pixels, run, false, scalar(colour), fine_width(width), cv::LINE_AA,
                    kSubpixelBits);
    }
    run.clear();
  };
  for (const Position& point : points) {
    if (finite(point)) {
      run.push_back(view.at(point));
    } else {
      flush();
    }
  }
  flush();
}

void Canvas::line(const std::vector<Position>& points, const Stroke& stroke) {
  const auto runs = stroke.dash > 0.0 ? dashes_of(points, stroke.dash)
                                      : std::vector<std::vector<Position>>{points};
  if (stroke.halo) {
    for (const auto& run : runs) plain_line(run, *stroke.halo, stroke.width + 2.0 * kHaloWidth);
  }
  for (const auto& run : runs) plain_line(run, stroke.colour, stroke.width);
}

void Canvas::outline(const std::vector<Position>& corners, const Stroke& stroke) {
  std::vector<Position> closed = corners;
  if (!closed.empty()) closed.push_back(closed.front());
  line(closed, stroke);
}

void Canvas::fill(const std::vector<Position>& corners, Colour colour, double opacity) {
  if (corners.empty() || !std::all_of(corners.begin(), corners.end(), finite)) return;
  View view(sheet_, clip_);
  std::vector<cv::Point> points;
  std::vector<cv::Point> whole;
  for (const Position& corner : corners) {
    points.push_back(view.at(corner));
    whole.emplace_back(points.back().x >> kSubpixelBits, points.back().y >> kSubpixelBits);
  }
  cv::Rect touched = cv::boundingRect(whole);
  touched += cv::Size(4, 4);
  touched -= cv::Point(2, 2);
  draw_with_opacity(view.pixels, touched, opacity, [&](cv::Mat pixels) {
    cv::fillPoly(pixels, std::vector<std::vector<cv::Point>>{points}, scalar(colour), cv::LINE_AA,
                 kSubpixelBits);
  });
}

void Canvas::disc(Position centre, double radius, Colour colour, double opacity) {
  if (!finite(centre)) return;
  View view(sheet_, clip_);
  const cv::Point at = view.at(centre);
  const int reach = fine_width(radius) + 3;
  const cv::Rect touched((at.x >> kSubpixelBits) - reach, (at.y >> kSubpixelBits) - reach,
                         2 * reach, 2 * reach);
  draw_with_opacity(view.pixels, touched, opacity, [&](cv::Mat pixels) {
    cv::circle(pixels, at, cvRound(kFine * radius * (1U << kSubpixelBits)), scalar(colour),
               cv::FILLED, cv::LINE_AA, kSubpixelBits);
  });
}

void Canvas::ring(Position centre, double radius, const Stroke& stroke) {
  constexpr int kCorners = 48;
  std::vector<Position> points;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * kPi * i / kCorners;
    points.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
  }
  outline(points, stroke);
}

void Canvas::arrow(Position tail, Position tip, const Stroke& stroke) {
  const double length = std::hypot(tip.x - tail.x, tip.y - tail.y);
  if (!(length > 0.0)) return;
  const double u = (tip.x - tail.x) / length;
  const double v = (tip.y - tail.y) / length;
  const double head = std::min(length, 5.0 * stroke.width);
  const double half = 0.42 * head;
  const Position neck{tip.x - 0.8 * head * u, tip.y - 0.8 * head * v};
  const Position base{tip.x - head * u, tip.y - head * v};
  const std::vector<Position> triangle{
      tip, {base.x - half * v, base.y + half * u}, {base.x + half * v, base.y - half * u}};
  if (stroke.halo) {
    outline(triangle, {*stroke.halo, 2.0 * kHaloWidth, {}, 0.0});
  }
  line({tail, neck}, stroke);
  fill(triangle, stroke.colour);
}

void Canvas::image(const Box& box, const Raster<std::uint8_t>& image,
                   const Raster<std::uint8_t>& opacity) {
  View view(sheet_, clip_);
  const int left = fine_pixels(box.left) - view.origin.x;
  const int top = fine_pixels(box.top) - view.origin.y;
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      const int x = left + column;
      const int y = top + row;
      if (x < 0 || y < 0 || x >= view.pixels.cols || y >= view.pixels.rows) continue;
      const int alpha = opacity.at(column, row);
      auto& pixel = view.pixels.at<cv::Vec3b>(y, x);
      for (int channel = 0; channel < 3; ++channel) {
        const int mixed = image.at(column, row, channel) * alpha + pixel[channel] * (255 - alpha);
        pixel[channel] = static_cast<std::uint8_t>((mixed + 127) / 255);
      }
    }
  }
}

Raster<std::uint8_t> Canvas::finish() const {
  Raster<std::uint8_t> sheet = sheet_;
  Raster<std::uint8_t> figure(width(), height(), 0, 3);
  const cv::Mat source(sheet.height(), sheet.width(), CV_8UC3, sheet.values().data());
  cv::Mat target(figure.height(), figure.width(), CV_8UC3, figure.values().data());
  cv::resize(source, target, target.size(), 0.0, 0.0, cv::INTER_AREA);
  return figure;
}

}  // namespace nadir::report
