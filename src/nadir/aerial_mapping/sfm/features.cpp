// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/features.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

namespace nadir::aerial {
namespace {

constexpr double kContrast = 0.02;  // half of OpenCV's: grass and asphalt are faint
constexpr int kCells = 12;          // along the longer side
constexpr double kSurplus = 1.5;    // found before they are spread

cv::Mat grey_of(const Raster<std::uint8_t>& image) {
  cv::Mat grey(image.height(), image.width(), CV_8U);
  for (int row = 0; row < image.height(); ++row) {
    const auto from = image.row(row);
    auto* to = grey.ptr<std::uint8_t>(row);
    if (image.channels() == 1) {
      std::memcpy(to, from.data(), from.size());
      continue;
    }
    for (int column = 0; column < image.width(); ++column) {
      const auto* p = from.data() + static_cast<std::ptrdiff_t>(column) * image.channels();
      // ITU-R BT.601 in sixteenths of a thousand, rounded
      to[column] = static_cast<std::uint8_t>((299 * p[0] + 587 * p[1] + 114 * p[2] + 500) / 1000);
    }
  }
  return grey;
}

/// A total order, so that what is kept does not depend on how the detector was scheduled.
bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  return std::tuple(-a.response, a.pt.x, a.pt.y, a.size, a.angle) <
         std::tuple(-b.response, b.pt.x, b.pt.y, b.size, b.angle);
}

/// The strongest of each cell, then the strongest of the rest, `limit` in all.
std::vector<std::size_t> spread(const std::vector<cv::KeyPoint>& points,
                                const std::vector<std::size_t>& order, cv::Size size, int limit) {
  const double cell = static_cast<double>(std::max(size.width, size.height)) / kCells;
  const int columns = static_cast<int>(std::ceil(size.width / cell));
  const int rows = static_cast<int>(std::ceil(size.height / cell));
  const int share = std::max(1, limit / (columns * rows));
  std::vector<int> taken(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  std::vector<std::size_t> kept;
  std::vector<std::size_t> rest;
  for (const std::size_t i : order) {
    const int column = std::clamp(static_cast<int>(points[i].pt.x / cell), 0, columns - 1);
    const int row = std::clamp(static_cast<int>(points[i].pt.y / cell), 0, rows - 1);
    const int bin = row * columns + column;
    int& count = taken[static_cast<std::size_t>(bin)];
    if (count < share) {
      ++count;
      kept.push_back(i);
    } else {
      rest.push_back(i);
    }
  }
  for (const std::size_t i : rest) {
    if (kept.size() >= static_cast<std::size_t>(limit)) break;
    kept.push_back(i);
  }
  kept.resize(std::min(kept.size(), static_cast<std::size_t>(limit)));
  return kept;
}

void to_root_sift(cv::Mat& descriptors) {
  for (int row = 0; row < descriptors.rows; ++row) {
    auto* d = descriptors.ptr<float>(row);
    float sum = 0.0F;
    for (int k = 0; k < descriptors.cols; ++k) sum += d[k];
    const float scale = sum > 0.0F ? 1.0F / sum : 0.0F;
    for (int k = 0; k < descriptors.cols; ++k) d[k] = std::sqrt(d[k] * scale);
  }
}

/// Mean absolute Laplacian.
double detail(const cv::Mat& grey) {
  cv::Mat second;
  cv::Laplacian(grey, second, CV_32F);
  return cv::norm(second, cv::NORM_L1) / static_cast<double>(second.total());
}

/// From half the size on, so that the noise of the sensor is no detail.
double sharpness_of(const cv::Mat& grey) {
  cv::Mat half;
  cv::Mat quarter;
  cv::resize(grey, half, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(half, quarter, {}, 0.5, 0.5, cv::INTER_AREA);
  return detail(half) / std::max(1e-6, detail(quarter));
}

}  // namespace

PhotoFeatures find_features(const Raster<std::uint8_t>& image, int limit) {
  const cv::Mat grey = grey_of(image);
  std::vector<cv::KeyPoint> points;
  cv::Mat descriptors;
  const auto sift = cv::SIFT::create(static_cast<int>(limit * kSurplus), 3, kContrast);
  sift->detectAndCompute(grey, cv::noArray(), points, descriptors);

  std::vector<std::size_t> order(points.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return stronger(points[a], points[b]); });
  std::vector<std::size_t> kept = spread(points, order, grey.size(), limit);
  std::stable_sort(kept.begin(), kept.end(),
                   [&](std::size_t a, std::size_t b) { return points[a].size > points[b].size; });

  PhotoFeatures features;
  features.sharpness = sharpness_of(grey);
  features.descriptors.create(static_cast<int>(kept.size()), 128, CV_32F);
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const cv::KeyPoint& p = points[kept[i]];
    features.points.push_back({p.pt.x, p.pt.y, p.size});
    descriptors.row(static_cast<int>(kept[i]))
        .copyTo(features.descriptors.row(static_cast<int>(i)));
  }
  to_root_sift(features.descriptors);
  return features;
}

std::size_t feature_memory(int width, int height) {
  // The first octave is of twice the size: 6 blurred and 5 difference images of floats, and a
  // third more for the smaller octaves.
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4U * 11U * 4U * 4U /
         3U;
}

std::uint64_t seed_of(std::string_view name) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : name) {
    hash ^= static_cast<unsigned char>(c);
    hash *= 1099511628211ULL;
  }
  return hash;
}

}  // namespace nadir::aerial
