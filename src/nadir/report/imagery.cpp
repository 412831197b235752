// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/imagery.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "nadir/report/map_view.hpp"

namespace nadir::report {
namespace {

/// A cut-out of the map, reduced by a whole factor: colour times validity, and validity (0 .. 1).
struct Reduced {
  cv::Mat colour;  ///< CV_32FC3
  cv::Mat weight;  ///< CV_32F
  int factor = 1;
  cv::Point origin;  ///< of the cut-out in the map
};

/// The map's pixels that a sheet needs, with one to spare.
cv::Rect needed(const Orthomosaic& map, const PixelTransform& a, int width, int height) {
  double left = 1e300, top = 1e300, right = -1e300, bottom = -1e300;
  for (const auto& [u, v] : {std::pair{0, 0}, {width, 0}, {0, height}, {width, height}}) {
    const double column = a[0] * u + a[1] * v + a[2];
    const double row = a[3] * u + a[4] * v + a[5];
    left = std::min(left, column);
    right = std::max(right, column);
    top = std::min(top, row);
    bottom = std::max(bottom, row);
  }
  const auto clamped = [](double value, int most) {
    return static_cast<int>(std::clamp(value, 0.0, static_cast<double>(most)));
  };
  const int x = clamped(std::floor(left) - 1.0, map.width());
  const int y = clamped(std::floor(top) - 1.0, map.height());
  return {x, y, clamped(std::ceil(right) + 1.0, map.width()) - x,
          clamped(std::ceil(bottom) + 1.0, map.height()) - y};
}

/// Means over blocks of factor x factor pixels; beyond the map nothing is valid. The map is never
/// held in single precision as a whole: maps are large.
Reduced cut_out(const Orthomosaic& map, const cv::Rect& rect, int factor) {
  const cv::Size size((rect.width + factor - 1) / factor, (rect.height + factor - 1) / factor);
  Reduced cut{cv::Mat::zeros(size, CV_32FC3), cv::Mat::zeros(size, CV_32F), factor, rect.tl()};
  const int last = map.image.channels() - 1;
  const float share = 1.0F / static_cast<float>(factor * factor);
  for (int row = 0; row < rect.height; ++row) {
    for (int column = 0; column < rect.width; ++column) {
      const int x = rect.x + column;
      const int y = rect.y + row;
      if (map.valid.at(x, y) == 0) continue;
      cut.weight.at<float>(row / factor, column / factor) += share;
      auto& pixel = cut.colour.at<cv::Vec3f>(row / factor, column / factor);
      for (int channel = 0; channel < 3; ++channel) {
        pixel[channel] += share * map.image.at(x, y, std::min(channel, last));
      }
    }
  }
  return cut;
}

/// From the pixels of a sheet, counted from row `first`, to those of the cut-out. Both count pixel
/// centres from 0 in OpenCV, and at +0.5 here.
cv::Matx23d warp_matrix(const PixelTransform& a, const Reduced& cut, int first) {
  const double x = a[2] + 0.5 * (a[0] + a[1]) + first * a[1] - cut.origin.x;
  const double y = a[5] + 0.5 * (a[3] + a[4]) + first * a[4] - cut.origin.y;
  const double factor = cut.factor;
  return {a[0] / factor, a[1] / factor, x / factor - 0.5,
          a[3] / factor, a[4] / factor, y / factor - 0.5};
}

/// Into the rows of the imagery from `first` on.
void divide_out(const cv::Mat& colour, const cv::Mat& weight, int first, Imagery& imagery) {
  for (int row = 0; row < weight.rows; ++row) {
    for (int column = 0; column < weight.cols; ++column) {
      const float share = weight.at<float>(row, column);
      if (share < 1e-3F) continue;
      const auto& pixel = colour.at<cv::Vec3f>(row, column);
      for (int channel = 0; channel < 3; ++channel) {
        imagery.colour.at(column, first + row, channel) =
            cv::saturate_cast<std::uint8_t>(pixel[channel] / share);
      }
      imagery.opacity.at(column, first + row) = cv::saturate_cast<std::uint8_t>(255.0F * share);
    }
  }
}

}  // namespace

Imagery resample(const Orthomosaic& map, const PixelTransform& map_from_sheet, int width,
                 int height) {
  Imagery imagery{Raster<std::uint8_t>(width, height, 0, 3), Raster<std::uint8_t>(width, height)};
  if (map.image.empty()) return imagery;
  const cv::Rect rect = needed(map, map_from_sheet, width, height);
  if (rect.width <= 0 || rect.height <= 0) return imagery;
  const double step = std::hypot(map_from_sheet[0], map_from_sheet[3]);
  const Reduced cut = cut_out(map, rect, std::max(1, static_cast<int>(step)));
  constexpr int kBand = 64;  // rows that are held in single precision at a time
  const int flags = cv::INTER_LINEAR | cv::WARP_INVERSE_MAP;
  cv::Mat colour;
  cv::Mat weight;
  for (int first = 0; first < height; first += kBand) {
    const cv::Matx23d matrix = warp_matrix(map_from_sheet, cut, first);
    const cv::Size band(width, std::min(kBand, height - first));
    cv::warpAffine(cut.colour, colour, matrix, band, flags, cv::BORDER_CONSTANT);
    cv::warpAffine(cut.weight, weight, matrix, band, flags, cv::BORDER_CONSTANT);
    divide_out(colour, weight, first, imagery);
  }
  return imagery;
}

void make_grey(Imagery& imagery, double lift) {
  auto& values = imagery.colour.values();
  for (std::size_t i = 0; i + 2 < values.size(); i += 3) {
    const double grey = 0.299 * values[i] + 0.587 * values[i + 1] + 0.114 * values[i + 2];
    const auto lifted = static_cast<std::uint8_t>(std::lround(grey + lift * (255.0 - grey)));
    values[i] = values[i + 1] = values[i + 2] = lifted;
  }
}

void draw_hatching(Canvas& canvas, const Box& box) {
  constexpr double kSpacing = 14.0;
  canvas.clip(box);
  canvas.fill(box.corners(), kNothing);
  const int lines = static_cast<int>(std::ceil((box.width + box.height) / kSpacing));
  for (int i = 0; i < lines; ++i) {
    const double x = box.left - box.height + kSpacing * i;
    canvas.line({{x, box.bottom()}, {x + box.height, box.top}}, {kHatching, 2.0, {}, 0.0});
  }
  canvas.unclip();
}

void draw_map(Canvas& canvas, const MapView& view, const Orthomosaic& map, Tint tint) {
  draw_hatching(canvas, view.box);
  const double step = 1.0 / (view.pixels_per_metre() * Canvas::kOversampling * map.geo.resolution);
  const PixelCoordinate corner = map.geo.pixel_at(view.region.west, view.region.north);
  Imagery imagery = resample(map, {step, 0.0, corner.column, 0.0, step, corner.row},
                             fine_pixels(view.box.width), fine_pixels(view.box.height));
  if (tint == Tint::kGrey) make_grey(imagery, 0.12);
  canvas.clip(view.box);
  canvas.image(view.box, imagery.colour, imagery.opacity);
  canvas.unclip();
}

}  // namespace nadir::report
