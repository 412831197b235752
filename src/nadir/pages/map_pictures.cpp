// SPDX-License-Identifier: Apache-2.0
#include "nadir/pages/map_pictures.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "nadir/pages/html_page.hpp"

namespace nadir {
namespace {

constexpr int kLargest = 1000;  // pixels of a side
const cv::Vec3b kNothing(255, 255, 255);

/// Blue first, as OpenCV has it.
Picture encoded(const cv::Mat& image, const std::string& format) {
  std::vector<std::uint8_t> bytes;
  cv::imencode("." + format, image, bytes);
  return {html::data_uri("image/" + format,
                         {reinterpret_cast<const char*>(bytes.data()), bytes.size()}),
          image.cols, image.rows};
}

cv::Mat reduced(const cv::Mat& image, int interpolation) {
  const double scale = static_cast<double>(kLargest) / std::max(image.cols, image.rows);
  if (scale >= 1.0) return image;
  cv::Mat small;
  cv::resize(image, small, {}, scale, scale, interpolation);
  return small;
}

/// Paints every pixel of a raster; `colour(column, row)`.
template <class Colour>
cv::Mat painted(int width, int height, Colour&& colour) {
  cv::Mat image(height, width, CV_8UC3);
  for (int row = 0; row < height; ++row) {
    for (int column = 0; column < width; ++column) {
      image.at<cv::Vec3b>(row, column) = colour(column, row);
    }
  }
  return image;
}

/// Neighbouring numbers get colours far apart: hues by the golden ratio.
cv::Vec3b colour_of(int number) {
  const double hue = std::fmod(number * 0.618033988749895, 1.0) * 6.0;
  const auto part = [&](double shift) {
    const double distance = std::abs(std::fmod(hue + shift, 6.0) - 3.0) - 1.0;
    return static_cast<std::uint8_t>(80.0 + 150.0 * std::clamp(distance, 0.0, 1.0));
  };
  return {part(2.0), part(4.0), part(0.0)};
}

}  // namespace

Picture colour_picture(const AerialMap& map) {
  const auto& image = map.ortho.image;
  const int last = image.channels() - 1;
  return encoded(reduced(painted(image.width(), image.height(),
                                 [&](int column, int row) {
                                   if (map.ortho.valid.at(column, row) == 0) return kNothing;
                                   return cv::Vec3b(image.at(column, row, last),
                                                    image.at(column, row, last / 2),
                                                    image.at(column, row, 0));
                                 }),
                         cv::INTER_AREA),
                 "jpeg");
}

Picture seam_picture(const AerialMap& map) {
  constexpr std::uint16_t kNone = 65535;
  const auto& source = map.source;
  return encoded(reduced(painted(source.width(), source.height(),
                                 [&](int column, int row) {
                                   const std::uint16_t photo = source.at(column, row);
                                   const bool seen = map.ortho.valid.at(column, row) != 0;
                                   return photo == kNone || !seen ? kNothing : colour_of(photo);
                                 }),
                         cv::INTER_NEAREST),
                 "png");
}

Picture view_picture(const AerialMap& map) {
  constexpr int kBright = 10;
  const auto& views = map.view_count;
  return encoded(reduced(painted(views.width(), views.height(),
                                 [&](int column, int row) {
                                   const int count = std::min<int>(views.at(column, row), kBright);
                                   if (count == 0) return kNothing;
                                   const auto level = static_cast<std::uint8_t>(count * 22 + 20);
                                   return cv::Vec3b(static_cast<std::uint8_t>(120 - level / 4),
                                                    level, static_cast<std::uint8_t>(level / 2));
                                 }),
                         cv::INTER_NEAREST),
                 "png");
}

Picture surface_picture(const AerialMap& map) {
  const auto& z = map.surface.height_m;
  const double cell = map.surface.geo.resolution;
  return encoded(
      reduced(painted(z.width(), z.height(),
                      [&](int column, int row) {
                        const int right = std::min(column + 1, z.width() - 1);
                        const int below = std::min(row + 1, z.height() - 1);
                        const double east = (z.at(right, row) - z.at(column, row)) / cell;
                        const double south = (z.at(column, below) - z.at(column, row)) / cell;
                        if (!std::isfinite(east + south)) return kNothing;
                        // Light from the north-west, 45 degrees high.
                        const double light = (east + south + std::sqrt(2.0)) /
                                             (2.0 * std::sqrt(1.0 + east * east + south * south));
                        const auto grey = cv::saturate_cast<std::uint8_t>(
                            40.0 + 200.0 * std::clamp(light, 0.0, 1.0));
                        return cv::Vec3b(grey, grey, grey);
                      }),
              cv::INTER_AREA),
      "png");
}

}  // namespace nadir
