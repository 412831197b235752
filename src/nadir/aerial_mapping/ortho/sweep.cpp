// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/sweep.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace nadir::aerial {
namespace {

// Lengths in flying heights.
constexpr double kSpacing = 0.02;  // of the places
constexpr double kSample = 0.004;  // between the samples of a patch
constexpr double kStep = 0.008;    // between heights
constexpr double kMargin = 0.05;   // of the heights that are tried, beyond those that are known

constexpr int kSide = 9;  // samples of a patch
constexpr int kSamples = kSide * kSide;
constexpr std::size_t kFewestViews = 3;
constexpr std::size_t kMostViews = 5;
constexpr double kAgree = 0.6;    // mean correlation of the views
constexpr double kClear = 0.12;   // by which it stands above that of other heights
constexpr int kOther = 3;         // steps from which on a height is another one
constexpr double kTexture = 3.0;  // grey levels, standard deviation in a patch

constexpr int kReach = 2;  // places to each side that vouch for one
constexpr std::size_t kFewestNear = 5;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

using Patch = std::array<double, kSamples>;

/// A photo in grey, its pixels as large as the samples.
struct SmallView {
  const View* view = nullptr;
  cv::Mat grey;
  double scale = 1.0;  ///< small pixels in a pixel of the camera
};

double median_height(const std::vector<View>& views, const Ground& ground) {
  std::vector<double> heights;
  for (const View& view : views)
    heights.push_back(view.centre.z() - ground.height_at(view.centre.x(), view.centre.y()));
  const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
  std::nth_element(heights.begin(), middle, heights.end());
  return *middle;
}

SmallView shrunk(const View& view, const cv::Mat& rgb, double height, double sample) {
  SmallView small{&view, {}, std::min(1.0, height / (view.camera.fx * sample))};
  cv::Mat grey;
  cv::cvtColor(rgb, grey, cv::COLOR_RGB2GRAY);
  const cv::Size size(std::max(1, static_cast<int>(std::lround(view.camera.width * small.scale))),
                      std::max(1, static_cast<int>(std::lround(view.camera.height * small.scale))));
  cv::resize(grey, small.grey, size, 0.0, 0.0, cv::INTER_AREA);
  return small;
}

/// The patch about a point as a view shows it: zero mean, norm one. Nothing where it is not wholly
/// seen or has no texture.
std::optional<Patch> patch_of(const SmallView& small, const Eigen::Vector3d& point, double sample) {
  Patch patch{};
  double mean = 0.0;
  for (int k = 0; k < kSamples; ++k) {
    const int east = k % kSide - kSide / 2;
    const int north = k / kSide - kSide / 2;
    const Eigen::Vector3d offset{east * sample, north * sample, 0.0};
    const View& view = *small.view;
    const auto pixel = view.project(point + offset);
    if (!pixel) return std::nullopt;
    const double u = (pixel->x() + 0.5) * small.scale - 0.5;
    const double v = (pixel->y() + 0.5) * small.scale - 0.5;
    if (u < 0.0 || v < 0.0 || u >= small.grey.cols - 1 || v >= small.grey.rows - 1)
      return std::nullopt;
    const int column = static_cast<int>(u);
    const int row = static_cast<int>(v);
    const double fc = u - column;
    const double fr = v - row;
    const auto* above = small.grey.ptr<std::uint8_t>(row) + column;
    const auto* below = small.grey.ptr<std::uint8_t>(row + 1) + column;
    auto& value = patch[static_cast<std::size_t>(k)];
    value = (1.0 - fr) * ((1.0 - fc) * above[0] + fc * above[1]) +
            fr * ((1.0 - fc) * below[0] + fc * below[1]);
    mean += value / kSamples;
  }
  double square = 0.0;
  for (double& value : patch) {
    value -= mean;
    square += value * value;
  }
  if (square < kTexture * kTexture * kSamples) return std::nullopt;
  for (double& value : patch) value /= std::sqrt(square);
  return patch;
}

/// Mean correlation of all pairs of patches; -1 where there are too few. The sum of n patches of
/// norm one has the square n + 2 sum of the correlations.
double agreement(const std::vector<const SmallView*>& views, const Eigen::Vector3d& point,
                 double sample) {
  Patch sum{};
  double count = 0.0;
  for (const SmallView* view : views) {
    const auto patch = patch_of(*view, point, sample);
    if (!patch) continue;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*patch)[k];
    count += 1.0;
  }
  if (count < kFewestViews) return -1.0;
  double square = 0.0;
  for (const double value : sum) square += value * value;
  return (square - count) / (count * (count - 1.0));
}

/// The views that see a point, the steepest first.
std::vector<const SmallView*> seeing(const std::vector<SmallView>& views, const ViewLimits& limits,
                                     const Eigen::Vector3d& point) {
  std::vector<std::pair<double, const SmallView*>> found;
  for (const SmallView& view : views)
    if (const auto sight = sight_of(*view.view, limits, point))
      found.emplace_back(sight->off_nadir_rad, &view);
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  found.resize(std::min(found.size(), kMostViews));
  std::vector<const SmallView*> views_there;
  for (const auto& [angle, view] : found) views_there.push_back(view);
  return views_there;
}

/// Heights that are tried.
struct Heights {
  double lowest = 0.0;
  double step = 0.4;
  int count = 0;
};

/// The height at which the views agree, where there is one.
std::optional<double> height_of(const std::vector<const SmallView*>& views, double x, double y,
                                const Heights& heights, double sample) {
  std::vector<double> scores;
  for (int k = 0; k < heights.count; ++k)
    scores.push_back(agreement(views, {x, y, heights.lowest + k * heights.step}, sample));
  const auto at = std::max_element(scores.begin(), scores.end());
  if (at == scores.end() || *at < kAgree) return std::nullopt;
  const auto best = at - scores.begin();
  for (std::ptrdiff_t k = 0; k < std::ssize(scores); ++k)
    if (std::abs(k - best) >= kOther && scores[static_cast<std::size_t>(k)] > *at - kClear)
      return std::nullopt;
  return heights.lowest + static_cast<double>(best) * heights.step;
}

Heights heights_of(const Ground& ground, double height, double max_distance_m) {
  std::vector<float> known;
  for (int row = 0; row < ground.heights.height(); ++row)
    for (int column = 0; column < ground.heights.width(); ++column)
      if (ground.is_known(column, row, max_distance_m))
        known.push_back(ground.heights.height_m.at(column, row));
  if (known.empty()) return {};
  std::sort(known.begin(), known.end());
  Heights heights;
  heights.step = kStep * height;
  heights.lowest = static_cast<double>(known[known.size() / 100]) - kMargin * height;
  const double highest =
      static_cast<double>(known[known.size() - 1 - known.size() / 100]) + kMargin * height;
  heights.count = 1 + static_cast<int>((highest - heights.lowest) / heights.step);
  return heights;
}

/// Median of the heights found in 5 x 5 places; nothing where there are few: what stands alone is
/// chance, and leaves that move make single heights rough.
std::optional<double> smoothed(const Raster<float>& found, int column, int row) {
  std::vector<float> near;
  for (int r = row - kReach; r <= row + kReach; ++r)
    for (int c = column - kReach; c <= column + kReach; ++c)
      if (found.contains(c, r) && !std::isnan(found.at(c, r))) near.push_back(found.at(c, r));
  if (near.size() < kFewestNear) return std::nullopt;
  const auto middle = near.begin() + static_cast<std::ptrdiff_t>(near.size() / 2);
  std::nth_element(near.begin(), middle, near.end());
  return static_cast<double>(*middle);
}

}  // namespace

std::vector<Eigen::Vector3d> sweep_gaps(const std::vector<View>& views, ViewImages& images,
                                        const Ground& ground, const ViewLimits& limits,
                                        double max_distance_m, const StopToken& stop) {
  if (views.size() < kFewestViews) return {};
  const double height = median_height(views, ground);
  const double sample = kSample * height;
  const Heights heights = heights_of(ground, height, max_distance_m);
  std::vector<SmallView> small(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t k) {
    stop.check();
    small[k] = shrunk(views[k], *images.get(k), height, sample);
  });
  const GeoReference& geo = ground.heights.geo;
  const double spacing = kSpacing * height;
  const int columns = static_cast<int>(ground.heights.width() * geo.resolution / spacing);
  const int rows = static_cast<int>(ground.heights.height() * geo.resolution / spacing);
  if (columns < 1 || rows < 1) return {};
  Raster<float> found(columns, rows, kNone);
  tbb::parallel_for(0, rows, [&](int row) {
    stop.check();
    for (int column = 0; column < columns; ++column) {
      const double x = geo.west + (column + 0.5) * spacing;
      const double y = geo.north - (row + 0.5) * spacing;
      if (ground.is_known_at(x, y, 0.5 * max_distance_m)) continue;
      const auto there = seeing(small, limits, {x, y, ground.height_at(x, y)});
      if (there.size() < kFewestViews) continue;
      if (const auto z = height_of(there, x, y, heights, sample))
        found.at(column, row) = static_cast<float>(*z);
    }
  });
  std::vector<Eigen::Vector3d> points;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      if (std::isnan(found.at(column, row))) continue;
      if (const auto z = smoothed(found, column, row))
        points.emplace_back(geo.west + (column + 0.5) * spacing, geo.north - (row + 0.5) * spacing,
                            *z);
    }
  return points;
}

}  // namespace nadir::aerial
