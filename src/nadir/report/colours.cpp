// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/colours.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace nadir::report {
namespace {

using Table = std::array<Colour, 256>;

Table table_of(int opencv_colour_map) {
  cv::Mat grey(1, 256, CV_8U);
  for (int i = 0; i < 256; ++i) grey.at<std::uint8_t>(0, i) = static_cast<std::uint8_t>(i);
  cv::Mat coloured;  // blue, green, red
  cv::applyColorMap(grey, coloured, opencv_colour_map);
  Table table;
  for (int i = 0; i < 256; ++i) {
    const auto& bgr = coloured.at<cv::Vec3b>(0, i);
    table[static_cast<std::size_t>(i)] = {bgr[2], bgr[1], bgr[0]};
  }
  return table;
}

}  // namespace

Colour track_colour(std::size_t index) {
  constexpr std::array<Colour, 7> kColours{kVermillion, kSkyBlue, kYellow, kGreen,
                                           kPurple,     kBlue,    kOrange};
  return kColours[index % kColours.size()];
}

Colour mapped_colour(ColourMap map, double share) {
  static const Table inferno_table = table_of(cv::COLORMAP_INFERNO);
  static const Table viridis_table = table_of(cv::COLORMAP_VIRIDIS);
  const auto index = static_cast<std::size_t>(std::lround(255.0 * std::clamp(share, 0.0, 1.0)));
  return map == ColourMap::kInferno ? inferno_table[index] : viridis_table[index];
}

}  // namespace nadir::report
