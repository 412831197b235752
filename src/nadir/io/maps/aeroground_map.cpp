// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/aeroground_map.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <span>
#include <vector>

#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir {
namespace {

constexpr int kBlackest = 4;         ///< brightest value of the unseen, after JPEG
constexpr int kWhitest = 250;        ///< darkest value of a hole, after JPEG
constexpr int kLargestShadow = 400;  ///< pixels; larger black regions are unseen
constexpr int kFringe = 2;           ///< pixels beside the unseen that JPEG mixed with black

/// A mask over the pixels, from the extreme value of each pixel's channels.
template <class Predicate>
Raster<std::uint8_t> pixels_where(const Raster<std::uint8_t>& image, Predicate is_member) {
  Raster<std::uint8_t> members(image.width(), image.height());
  const auto channels = static_cast<std::size_t>(image.channels());
  for (std::size_t i = 0; i < members.values().size(); ++i) {
    const std::span<const std::uint8_t> pixel(image.values().data() + i * channels, channels);
    members.values()[i] = std::all_of(pixel.begin(), pixel.end(), is_member) ? kSeen : 0;
  }
  return members;
}

bool touches_border(const cv::Mat& statistics, int region, const Raster<std::uint8_t>& image) {
  const int left = statistics.at<int>(region, cv::CC_STAT_LEFT);
  const int top = statistics.at<int>(region, cv::CC_STAT_TOP);
  return left == 0 || top == 0 ||
         left + statistics.at<int>(region, cv::CC_STAT_WIDTH) == image.width() ||
         top + statistics.at<int>(region, cv::CC_STAT_HEIGHT) == image.height();
}

}  // namespace

Raster<std::uint8_t> without_equal_channels(Raster<std::uint8_t> image) {
  if (image.channels() != 3) return image;
  Raster<std::uint8_t> grey(image.width(), image.height());
  for (std::size_t i = 0; i < grey.values().size(); ++i) {
    const std::uint8_t* pixel = image.values().data() + 3 * i;
    if (pixel[0] != pixel[1] || pixel[0] != pixel[2]) return image;
    grey.values()[i] = pixel[0];
  }
  return grey;
}

Raster<std::uint8_t> seen_by_drone(const Raster<std::uint8_t>& image) {
  Raster<std::uint8_t> black =
      pixels_where(image, [](std::uint8_t value) { return value <= kBlackest; });
  const cv::Mat view(image.height(), image.width(), CV_8UC1, black.values().data());
  cv::Mat regions;
  cv::Mat statistics;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(view, regions, statistics, centroids, 8);
  std::vector<bool> unseen(static_cast<std::size_t>(count), false);
  for (int region = 1; region < count; ++region) {  // region 0 is what is not black
    unseen[static_cast<std::size_t>(region)] =
        statistics.at<int>(region, cv::CC_STAT_AREA) > kLargestShadow ||
        touches_border(statistics, region, image);
  }
  for (int row = 0; row < image.height(); ++row) {
    for (int column = 0; column < image.width(); ++column) {
      const auto region = static_cast<std::size_t>(regions.at<int>(row, column));
      black.at(column, row) = unseen[region] ? 0 : kSeen;
    }
  }
  Raster<std::uint8_t> seen(image.width(), image.height());
  cv::Mat result(image.height(), image.width(), CV_8UC1, seen.values().data());
  constexpr int kSide = 2 * kFringe + 1;
  cv::erode(view, result, cv::Mat::ones(kSide, kSide, CV_8UC1));
  return seen;
}

Raster<std::uint8_t> seen_by_robot(const Raster<std::uint8_t>& image) {
  Raster<std::uint8_t> seen =
      pixels_where(image, [](std::uint8_t value) { return value >= kWhitest; });
  for (std::uint8_t& value : seen.values()) value = value == 0 ? kSeen : 0;
  return seen;
}

}  // namespace nadir
