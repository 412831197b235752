// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/traversability.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <utility>

namespace nadir::simulation {
namespace {

constexpr double kPreferred = 4.0;  ///< clearance at which a metre costs twice what it does far off
constexpr double kOfEnds = 3.0;     ///< clearance of both ends, where there are such places
constexpr double kTolerance = 0.3;  ///< metres that the corners may be off the cells of the path
constexpr double kShortest = 20.0;  ///< metres

/// Neighbours of a cell: 8 around it and 8 a knight's move away, for 16 headings.
constexpr std::array<std::array<int, 2>, 16> kSteps{{{1, 0},
                                                     {0, 1},
                                                     {-1, 0},
                                                     {0, -1},
                                                     {1, 1},
                                                     {-1, 1},
                                                     {-1, -1},
                                                     {1, -1},
                                                     {2, 1},
                                                     {1, 2},
                                                     {-1, 2},
                                                     {-2, 1},
                                                     {-2, -1},
                                                     {-1, -2},
                                                     {1, -2},
                                                     {2, -1}}};

/// The largest connected part of a mask; empty where the mask is.
cv::Mat1b largest_part(const cv::Mat1b& mask) {
  cv::Mat1i labels;
  cv::Mat1i stats;
  cv::Mat1d centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, 4);
  int largest = 0;
  for (int label = 1; label < count; ++label) {
    if (largest == 0 || stats(label, cv::CC_STAT_AREA) > stats(largest, cv::CC_STAT_AREA)) {
      largest = label;
    }
  }
  if (largest == 0) return {};
  cv::Mat1b part(labels == largest);
  return part;
}

/// The cheapest paths from one cell to all others of a part (Dijkstra's algorithm).
struct ShortestPathTree {
  cv::Mat1d cost;
  cv::Mat1i predecessor;  ///< index of a cell; -1 at the root
  cv::Point costliest;    ///< of the ends
};

bool contains(const cv::Mat1b& part, const cv::Point& cell) {
  return cell.x >= 0 && cell.y >= 0 && cell.x < part.cols && cell.y < part.rows && part(cell) != 0;
}

ShortestPathTree paths_from(const cv::Point& root, const cv::Mat1b& part, const cv::Mat1d& price,
                            const cv::Mat1b& ends) {
  ShortestPathTree tree{cv::Mat1d(part.size(), std::numeric_limits<double>::infinity()),
                        cv::Mat1i(part.size(), -1), root};
  using Entry = std::pair<double, int>;  // of equal costs the lower index comes first
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  tree.cost(root) = 0.0;
  open.emplace(0.0, root.y * part.cols + root.x);
  while (!open.empty()) {
    const auto [cost, index] = open.top();
    open.pop();
    const cv::Point at(index % part.cols, index / part.cols);
    if (cost > tree.cost(at)) continue;
    if (ends(at) != 0) tree.costliest = at;  // cells leave the queue by rising cost
    for (const auto& [dx, dy] : kSteps) {
      const cv::Point next(at.x + dx, at.y + dy);
      // The cells that a knight's move passes between; the ends of a shorter one.
      const cv::Point first(at.x + dx / 2, at.y + dy / 2);
      const cv::Point second(next.x - dx / 2, next.y - dy / 2);
      if (!contains(part, next) || !contains(part, first) || !contains(part, second)) continue;
      const double total = cost + std::hypot(dx, dy) * 0.5 * (price(at) + price(next));
      if (total >= tree.cost(next)) continue;
      tree.cost(next) = total;
      tree.predecessor(next) = index;
      open.emplace(total, next.y * part.cols + next.x);
    }
  }
  return tree;
}

std::vector<cv::Point> path_to(const cv::Point& end, const ShortestPathTree& tree) {
  std::vector<cv::Point> path{end};
  for (int index = tree.predecessor(end); index >= 0; index = tree.predecessor(path.back())) {
    path.emplace_back(index % tree.cost.cols, index / tree.cost.cols);
  }
  return path;
}

}  // namespace

TraversabilityGrid::TraversabilityGrid(const Raster<std::uint8_t>& free, Eigen::Vector2d low,
                                       double cell_m)
    : low_(std::move(low)), cell_m_(cell_m) {
  cv::Mat1b framed(free.height() + 2, free.width() + 2, std::uint8_t{0});  // beyond is not free
  for (int row = 0; row < free.height(); ++row) {
    for (int column = 0; column < free.width(); ++column) {
      framed(row + 1, column + 1) = free.at(column, row);
    }
  }
  cv::Mat1f distance;
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  clearance_ = distance(cv::Rect(1, 1, free.width(), free.height())).clone();
}

double TraversabilityGrid::clearance(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cell = (point - low_) / cell_m_;
  if (!(cell.x() >= 0.0 && cell.y() >= 0.0 && cell.x() < clearance_.cols &&
        cell.y() < clearance_.rows)) {
    return 0.0;
  }
  return cell_m_ *
         static_cast<double>(clearance_(static_cast<int>(cell.y()), static_cast<int>(cell.x())));
}

std::vector<Eigen::Vector2d> TraversabilityGrid::path() const {
  if (clearance_.empty()) return {};
  const cv::Mat1b part = largest_part(cv::Mat1b(clearance_ >= kClearance / cell_m_));
  if (part.empty()) return {};
  cv::Mat1d price(part.size());
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.cols; ++column) {
      const double near =
          kPreferred / (cell_m_ * static_cast<double>(std::max(clearance_(row, column), 0.5F)));
      price(row, column) = 1.0 + near * near;
    }
  }
  double most = 0.0;
  cv::Point widest;
  cv::minMaxLoc(clearance_, nullptr, &most, nullptr, &widest, part);
  const cv::Mat1b ends(part & cv::Mat(clearance_ >= std::min(kOfEnds / cell_m_, most)));
  const cv::Point end = paths_from(widest, part, price, ends).costliest;
  const ShortestPathTree tree = paths_from(end, part, price, ends);
  std::vector<cv::Point> corners;
  cv::approxPolyDP(path_to(tree.costliest, tree), corners, kTolerance / cell_m_, false);
  std::vector<Eigen::Vector2d> path;
  double length = 0.0;
  for (const cv::Point& corner : corners) {
    path.emplace_back(low_ + cell_m_ * Eigen::Vector2d(corner.x + 0.5, corner.y + 0.5));
    if (path.size() > 1) length += (path.back() - path[path.size() - 2]).norm();
  }
  return length > kShortest ? path : std::vector<Eigen::Vector2d>{};
}

}  // namespace nadir::simulation
