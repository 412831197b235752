// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/markings.hpp"

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "nadir/core/angle.hpp"
#include "nadir/core/random.hpp"

namespace nadir::simulation {
namespace {

constexpr double kDashPeriod = 7.0;
constexpr double kDashLength = 3.0;
constexpr double kZebraHalfLength = 1.6;
constexpr int kSubpixelBits = 4;

enum Layer : std::uint32_t { kPaintWear = 40, kPaintFlakes, kCoverRust };

struct Cover {
  RoadPoint at;
  bool round;  ///< a manhole; else a drain
};

struct Layout {
  std::vector<double> zebras;     ///< along, their middles
  std::vector<RoadPoint> arrows;  ///< their tails; left of the centre line they point west
  std::vector<Cover> covers;
};

Layout lay_out(const Place& place) {
  const RandomStream random(place.seed, stream_of(Source::kFurniture));
  Layout layout;
  std::uint64_t draw = 0;
  const double first = place.road.along_at(0.0);
  const double last = place.road.along_at(place.length_m);
  double along = first + random.uniform(draw++, 18.0, 40.0);
  while (along < last) {
    layout.zebras.push_back(along);
    layout.arrows.push_back({along - random.uniform(draw++, 11.0, 15.0), -kLaneMiddle});
    layout.arrows.push_back({along + random.uniform(draw++, 11.0, 15.0), kLaneMiddle});
    along += random.uniform(draw++, 45.0, 65.0);
  }
  along = first + random.uniform(draw++, 2.0, 9.0);
  while (along < last) {
    const double side = random.uniform(draw++) < 0.5 ? -1.0 : 1.0;
    const bool round = random.uniform(draw++) < 0.55;
    const double across = round ? random.uniform(draw++, 0.8, 2.4) : kKerbInner - 0.24;
    layout.covers.push_back({{along, side * across}, round});
    along += random.uniform(draw++, 7.0, 15.0);
  }
  return layout;
}

/// Share of white paint at a place, before wear.
double line_share(const Layout& layout, RoadPoint at) {
  const double side = std::abs(at.across);
  double dashes =
      strip(std::fmod(at.along + 1000.0 * kDashPeriod, kDashPeriod), 0.05, kDashLength) *
      strip(at.across, -0.09, 0.09);
  double share = strip(side, kEdgeLine - 0.08, kEdgeLine + 0.08);
  for (const double zebra : layout.zebras) {
    const double offset = at.along - zebra;
    if (std::abs(offset) < kZebraHalfLength + 3.0) dashes = 0.0;
    const double stripe = std::abs(std::remainder(at.across - 0.5, 1.0));
    share = std::max(share, strip(offset, -kZebraHalfLength, kZebraHalfLength) *
                                (1.0 - smooth_step(0.23, 0.28, stripe)) *
                                (1.0 - smooth_step(2.95, 3.0, side)));
    const double ahead = at.across < 0.0 ? -offset : offset;  // traffic keeps to the right
    share = std::max(share, strip(ahead, 2.6, 2.95) * strip(side, 0.15, 3.1));
  }
  return std::max(share, dashes);
}

cv::Point to_fixed(const Painting& painting, Point2<frames::Map> point) {
  const PixelCoordinate pixel = painting.geo.pixel_at(point.x, point.y);
  constexpr double kOne = 1U << kSubpixelBits;
  return {cvRound((pixel.column - 0.5) * kOne), cvRound((pixel.row - 0.5) * kOne)};
}

/// An arrow painted on the lane, 4 m long.
void stamp_arrow(const Place& place, const Painting& painting, RoadPoint tail, cv::Mat& mask) {
  constexpr std::array<RoadPoint, 7> kOutline{
      RoadPoint{0.0, 0.08},  RoadPoint{2.5, 0.08},  RoadPoint{2.5, 0.34}, RoadPoint{4.0, 0.0},
      RoadPoint{2.5, -0.34}, RoadPoint{2.5, -0.08}, RoadPoint{0.0, -0.08}};
  const double forward = tail.across < 0.0 ? 1.0 : -1.0;
  std::vector<cv::Point> outline;
  for (const RoadPoint& corner : kOutline) {
    outline.push_back(to_fixed(painting, place.road.place({tail.along + forward * corner.along,
                                                           tail.across + corner.across})));
  }
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{outline}, cv::Scalar(255), cv::LINE_AA,
               kSubpixelBits);
}

/// One crack: a walk over the carriageway that keeps its direction roughly.
std::vector<cv::Point> crack(const Place& place, const Painting& painting, std::uint64_t number) {
  const RandomStream random(place.seed, stream_of(Source::kCracks));
  std::uint64_t draw = number << 12U;
  const bool transverse = random.uniform(draw++) < 0.4;
  const double start = random.uniform(draw++);
  const double across = random.uniform(draw++, -3.2, 3.2);
  RoadPoint at{place.road.along_at(0.0) + start * place.length_m,
               transverse ? -kKerbInner : across};
  double direction = (transverse ? 0.5 * kPi : 0.0) + random.uniform(draw++, -0.35, 0.35);
  const double wanted = direction;
  const double length = transverse ? 9.0 : random.uniform(draw++, 2.0, 12.0);
  constexpr double kStep = 0.18;
  std::vector<cv::Point> points;
  double walked = 0.0;
  while (walked < length) {
    points.push_back(to_fixed(painting, place.road.place(at)));
    direction += 0.45 * random.normal(draw++) + 0.25 * (wanted - direction);
    at.along += kStep * std::cos(direction);
    at.across += kStep * std::sin(direction);
    if (std::abs(at.across) > kKerbInner) break;
    walked += kStep;
  }
  return points;
}

cv::Mat crack_mask(const Place& place, const Painting& painting) {
  cv::Mat mask(painting.image.height(), painting.image.width(), CV_8U, cv::Scalar(0));
  const auto count = static_cast<std::uint64_t>(place.length_m / 2.5);
  for (std::uint64_t number = 0; number < count; ++number) {
    const auto points = crack(place, painting, number);
    cv::polylines(mask, points, false, cv::Scalar(number % 3 == 0 ? 255 : 150), 1, cv::LINE_AA,
                  kSubpixelBits);
  }
  return mask;
}

cv::Mat arrow_mask(const Place& place, const Painting& painting, const Layout& layout) {
  cv::Mat mask(painting.image.height(), painting.image.width(), CV_8U, cv::Scalar(0));
  for (const RoadPoint& tail : layout.arrows) stamp_arrow(place, painting, tail, mask);
  return mask;
}

double cover_share(const Cover& cover, RoadPoint at, double& tone) {
  const double u = at.along - cover.at.along;
  const double v = at.across - cover.at.across;
  if (std::abs(u) > 0.6 || std::abs(v) > 0.6) return 0.0;
  if (!cover.round) {
    tone = std::abs(std::remainder(u, 0.12)) < 0.03 ? 22.0 : 74.0;  // slots of the grate
    return strip(u, -0.28, 0.28) * strip(v, -0.2, 0.2);
  }
  const double radius = std::hypot(u, v);
  const bool ring = radius > 0.29 || (radius > 0.10 && radius < 0.14);
  tone = ring ? 62.0 : 84.0 + 8.0 * std::sin(28.0 * u) * std::sin(28.0 * v);
  return 1.0 - smooth_step(0.34, 0.39, radius);
}

Colour painted(const Place& place, const Layout& layout, Point2<frames::Map> p, RoadPoint at,
               double arrow, Colour colour) {
  const double wear = place.noise.fractal(p.x, p.y, 2.2, 4, kPaintWear);
  const double flakes = place.noise.fractal(p.x, p.y, 0.25, 2, kPaintFlakes);
  const double kept = 0.90 * smooth_step(-0.85, -0.15, wear + 0.55 * flakes);
  const double share = kept * std::max(arrow, line_share(layout, at));
  colour = mix(colour, Colour{222, 221, 213} * (1.0 + 0.08 * flakes), share);
  for (const Cover& cover : layout.covers) {
    double tone = 0.0;
    const double covered = cover_share(cover, at, tone);
    if (covered > 0.0) {
      tone += 10.0 * place.noise.fractal(p.x, p.y, 0.3, 2, kCoverRust);
      colour = mix(colour, Colour{1.05, 1.0, 0.95} * tone, covered);
    }
  }
  return colour;
}

}  // namespace

void paint_carriageway(const Place& place, Painting& painting) {
  const Layout layout = lay_out(place);
  const cv::Mat cracks = crack_mask(place, painting);
  const cv::Mat arrows = arrow_mask(place, painting, layout);
  for (int row = 0; row < painting.image.height(); ++row) {
    for (int column = 0; column < painting.image.width(); ++column) {
      const Point2<frames::Map> p = painting.centre(column, row);
      const RoadPoint at = place.road.locate(p);
      if (std::abs(at.across) > kKerbInner) continue;
      const double crack = cracks.at<std::uint8_t>(row, column) / 255.0;
      const Colour worn = painting.colour(column, row) * (1.0 - 0.42 * crack);
      const double arrow = arrows.at<std::uint8_t>(row, column) / 255.0;
      painting.set(column, row, painted(place, layout, p, at, arrow, worn));
    }
  }
}

}  // namespace nadir::simulation
