// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/cells.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#ifdef NADIR_HAS_SFM
#include <opencv2/stitching/detail/seam_finders.hpp>
#endif

namespace nadir::aerial {
namespace {

constexpr float kUnseen = std::numeric_limits<float>::infinity();
constexpr double kEdgeCost = 0.3;          // of a place at the border of its photo
constexpr double kRoughCost = 0.3;         // of ground that rises by 1 m in 1 m, seen obliquely
constexpr double kRampCost = 1.0;          // where the top of a step may be in the way
constexpr double kHiddenCost = 8.0;        // shows what hides the place: better than a hole in it
constexpr float kProvisionalCost = 20.0F;  // any other view is better
constexpr float kBlurredCost = 4.0F;       // any sharp view is better, whatever its angle
constexpr float kBand = 0.35F;             // of cost, in which a border may move

Eigen::Vector3d point_of(const CellGrid& grid, const Ground& ground, int column, int row) {
  const double x = grid.geo.x_at(column + 0.5);
  const double y = grid.geo.y_at(row + 0.5);
  return {x, y, ground.height_at(x, y)};
}

/// The part of the grid that a view can see: its cells are found by a coarse walk.
cv::Rect part_of(const View& view, const Ground& ground, const CellGrid& grid,
                 const ViewLimits& limits) {
  constexpr int kStride = 4;
  int left = grid.width;
  int right = -1;
  int top = grid.height;
  int bottom = -1;
  for (int row = 0; row < grid.height; row += kStride)
    for (int column = 0; column < grid.width; column += kStride) {
      if (!sight_of(view, limits, point_of(grid, ground, column, row))) continue;
      left = std::min(left, column);
      right = std::max(right, column);
      top = std::min(top, row);
      bottom = std::max(bottom, row);
    }
  if (right < left) return {};
  const cv::Rect found(left - kStride, top - kStride, right - left + 2 * kStride + 1,
                       bottom - top + 2 * kStride + 1);
  return found & cv::Rect(0, 0, grid.width, grid.height);
}

double roughness(const CellGrid& grid, const Ground& ground, const Eigen::Vector3d& point) {
  const double d = grid.geo.resolution;
  const double east = ground.height_at(point.x() + d, point.y());
  const double west = ground.height_at(point.x() - d, point.y());
  const double north = ground.height_at(point.x(), point.y() + d);
  const double south = ground.height_at(point.x(), point.y() - d);
  return std::min(2.0, std::hypot(east - west, north - south) / (2.0 * d));
}

ViewCells look_through(const View& view, const Ground& ground, const CellGrid& grid,
                       const ViewLimits& limits, const cv::Mat& image) {
  ViewCells cells;
  cells.rect = part_of(view, ground, grid, limits);
  if (cells.rect.empty()) return cells;
  cells.cost = cv::Mat(cells.rect.size(), CV_32F, cv::Scalar(kUnseen));
  cv::Mat u(cells.rect.size(), CV_32F, cv::Scalar(-1));
  cv::Mat v(cells.rect.size(), CV_32F, cv::Scalar(-1));
  const double height =
      std::max(1e-6, view.centre.z() - ground.height_at(view.centre.x(), view.centre.y()));
  // The photo shrunk to the size of the cells.
  const double per_cell = grid.geo.resolution * view.camera.fx / height;
  const double scale = std::min(1.0, 1.0 / std::max(per_cell, 1e-6));
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(view.camera.width * scale))),
                      std::max(1, static_cast<int>(std::lround(view.camera.height * scale))));
  cv::resize(image, small, size, 0.0, 0.0, cv::INTER_AREA);
  const double su = static_cast<double>(small.cols) / view.camera.width;
  const double sv = static_cast<double>(small.rows) / view.camera.height;

  for (int row = 0; row < cells.rect.height; ++row)
    for (int column = 0; column < cells.rect.width; ++column) {
      const Eigen::Vector3d point =
          point_of(grid, ground, cells.rect.x + column, cells.rect.y + row);
      const auto sight = sight_of(view, limits, point);
      if (!sight) continue;
      const Occlusion occlusion = occlusion_of(view, ground, point);
      const double lean = std::tan(sight->off_nadir_rad) / std::tan(limits.max_off_nadir_rad);
      const double cost = lean * lean + kEdgeCost * (1.0 - std::min(1.0, sight->edge)) +
                          kRoughCost * lean * roughness(grid, ground, point) +
                          (occlusion == Occlusion::kByARamp ? kRampCost : 0.0) +
                          (occlusion == Occlusion::kByGround ? kHiddenCost : 0.0);
      cells.cost.at<float>(row, column) = static_cast<float>(cost) +
                                          (view.blurred ? kBlurredCost : 0.0F) +
                                          (view.provisional ? kProvisionalCost : 0.0F);
      u.at<float>(row, column) = static_cast<float>((sight->u + 0.5) * su - 0.5);
      v.at<float>(row, column) = static_cast<float>((sight->v + 0.5) * sv - 0.5);
    }
  cv::remap(small, cells.colour, u, v, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return cells;
}

cv::Mat best_view(const std::vector<ViewCells>& cells, const CellGrid& grid, cv::Mat& best_cost) {
  cv::Mat labels(grid.height, grid.width, CV_16U, cv::Scalar(kNoView));
  best_cost = cv::Mat(grid.height, grid.width, CV_32F, cv::Scalar(kUnseen));
  for (std::size_t k = 0; k < cells.size(); ++k)
    for (int row = 0; row < cells[k].rect.height; ++row)
      for (int column = 0; column < cells[k].rect.width; ++column) {
        const float cost = cells[k].cost.at<float>(row, column);
        auto& best = best_cost.at<float>(cells[k].rect.y + row, cells[k].rect.x + column);
        if (!(cost < best)) continue;
        best = cost;
        labels.at<std::uint16_t>(cells[k].rect.y + row, cells[k].rect.x + column) =
            static_cast<std::uint16_t>(k);
      }
  return labels;
}

#ifdef NADIR_HAS_SFM
/// Whether any cell is in both masks, which lie at these places of the grid.
bool masks_meet(const cv::Rect& first, const cv::UMat& first_mask, const cv::Rect& second,
                const cv::UMat& second_mask) {
  const cv::Rect common = first & second;
  if (common.empty()) return false;
  cv::Mat both;
  cv::bitwise_and(first_mask.getMat(cv::ACCESS_READ)(common - first.tl()),
                  second_mask.getMat(cv::ACCESS_READ)(common - second.tl()), both);
  return cv::countNonZero(both) > 0;
}

/// Graph cuts between each two neighbouring views, inside the band where either would do.
void move_seams(const std::vector<ViewCells>& cells, const std::vector<View>& views,
                const cv::Mat& best_cost, const StopToken& stop, cv::Mat& labels) {
  std::vector<std::size_t> taking_part;
  std::vector<cv::UMat> images;
  std::vector<cv::UMat> masks;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    if (cells[k].rect.empty()) continue;
    stop.check();
    cv::Mat mask(cells[k].rect.size(), CV_8U, cv::Scalar(0));
    for (int row = 0; row < mask.rows; ++row)
      for (int column = 0; column < mask.cols; ++column) {
        const float best = best_cost.at<float>(cells[k].rect.y + row, cells[k].rect.x + column);
        if (cells[k].cost.at<float>(row, column) <= best + kBand)
          mask.at<std::uint8_t>(row, column) = 255;
      }
    cv::Mat colour;
    cells[k].colour.convertTo(colour, CV_32FC3);
    const auto& gain = views[k].gain;
    cv::multiply(colour, cv::Scalar(gain[0], gain[1], gain[2]), colour);
    taking_part.push_back(k);
    images.push_back(colour.getUMat(cv::ACCESS_READ).clone());
    masks.push_back(mask.getUMat(cv::ACCESS_READ).clone());
  }
  // The finder goes through all pairs too, in this order, and a pair's cut depends on these two
  // alone; but it cannot be stopped, and cuts pairs whose masks nowhere meet, which changes
  // nothing.
  cv::detail::GraphCutSeamFinder finder(cv::detail::GraphCutSeamFinderBase::COST_COLOR_GRAD);
  for (std::size_t a = 0; a < taking_part.size(); ++a)
    for (std::size_t b = a + 1; b < taking_part.size(); ++b) {
      const cv::Rect& first = cells[taking_part[a]].rect;
      const cv::Rect& second = cells[taking_part[b]].rect;
      if (!masks_meet(first, masks[a], second, masks[b])) continue;
      stop.check();
      std::vector<cv::UMat> pair{masks[a], masks[b]};
      finder.find({images[a], images[b]}, {first.tl(), second.tl()}, pair);
    }
  cv::Mat left_cost(labels.size(), CV_32F, cv::Scalar(kUnseen));
  for (std::size_t n = 0; n < taking_part.size(); ++n) {
    const std::size_t k = taking_part[n];
    const cv::Mat mask = masks[n].getMat(cv::ACCESS_READ);
    for (int row = 0; row < mask.rows; ++row)
      for (int column = 0; column < mask.cols; ++column) {
        if (mask.at<std::uint8_t>(row, column) == 0) continue;
        const cv::Point at(cells[k].rect.x + column, cells[k].rect.y + row);
        const float cost = cells[k].cost.at<float>(row, column);
        if (!(cost < left_cost.at<float>(at))) continue;
        left_cost.at<float>(at) = cost;
        labels.at<std::uint16_t>(at) = static_cast<std::uint16_t>(k);
      }
  }
}
#endif

}  // namespace

std::vector<ViewCells> look(const std::vector<View>& views, const Ground& ground,
                            const CellGrid& grid, const ViewLimits& limits, ViewImages& images,
                            const StopToken& stop) {
  std::vector<ViewCells> cells(views.size());
  tbb::parallel_for(std::size_t{0}, views.size(), [&](std::size_t k) {
    stop.check();
    cells[k] = look_through(views[k], ground, grid, limits, *images.get(k));
  });
  return cells;
}

cv::Mat count_views(const std::vector<ViewCells>& cells, const CellGrid& grid) {
  cv::Mat count(grid.height, grid.width, CV_8U, cv::Scalar(0));
  for (const ViewCells& view : cells)
    for (int row = 0; row < view.rect.height; ++row)
      for (int column = 0; column < view.rect.width; ++column) {
        if (!(view.cost.at<float>(row, column) < kHiddenCost)) continue;
        auto& n = count.at<std::uint8_t>(view.rect.y + row, view.rect.x + column);
        n = static_cast<std::uint8_t>(std::min(255, n + 1));
      }
  return count;
}

void keep_from_clipping(const std::vector<ViewCells>& cells, const cv::Mat& labels,
                        std::vector<View>& views) {
  constexpr float kBrightest = 245.0F;
  constexpr double kMayClip = 0.005;  // share of the cells
  constexpr float kLowest = 0.75F;
  std::vector<float> brightness;
  for (int row = 0; row < labels.rows; ++row)
    for (int column = 0; column < labels.cols; ++column) {
      const std::uint16_t label = labels.at<std::uint16_t>(row, column);
      if (label == kNoView) continue;
      const cv::Vec3b colour = cells[label].colour.at<cv::Vec3b>(row - cells[label].rect.y,
                                                                 column - cells[label].rect.x);
      float brightest = 0.0F;
      for (int channel = 0; channel < 3; ++channel)
        brightest = std::max(brightest, static_cast<float>(colour[channel]) *
                                            views[label].gain[static_cast<std::size_t>(channel)]);
      brightness.push_back(brightest);
    }
  if (brightness.empty()) return;
  const auto at =
      brightness.begin() +
      static_cast<std::ptrdiff_t>((1.0 - kMayClip) * static_cast<double>(brightness.size() - 1));
  std::nth_element(brightness.begin(), at, brightness.end());
  const float factor = std::clamp(kBrightest / std::max(*at, 1.0F), kLowest, 1.0F);
  for (View& view : views)
    for (float& gain : view.gain) gain *= factor;
}

cv::Mat choose_views(const std::vector<ViewCells>& cells, const std::vector<View>& views,
                     const CellGrid& grid, bool optimise_seams, const StopToken& stop) {
  cv::Mat best_cost;
  cv::Mat labels = best_view(cells, grid, best_cost);
#ifdef NADIR_HAS_SFM
  if (optimise_seams) move_seams(cells, views, best_cost, stop, labels);
#else
  static_cast<void>(views);
  static_cast<void>(optimise_seams);
  static_cast<void>(stop);
#endif
  return labels;
}

}  // namespace nadir::aerial
