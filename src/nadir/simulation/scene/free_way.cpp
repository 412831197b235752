// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/free_way.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <utility>

namespace nadir::simulation {
namespace {

constexpr double kClearance = 1.5;  ///< metres
constexpr double kComfort = 4.0;    ///< clearance at which a metre costs twice a free one
constexpr double kEnd = 3.0;        ///< clearance of both ends, where there are such places
constexpr double kStraight = 0.3;   ///< metres that a way may be off its cells

/// Distance of the cells from what is not free, in cells; the border of the raster is not.
cv::Mat1f clearance_of(const Raster<std::uint8_t>& free) {
  const cv::Mat1b cells(free.height(), free.width(),
                        const_cast<std::uint8_t*>(free.values().data()));
  cv::Mat1b framed;
  cv::copyMakeBorder(cells, framed, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::Mat1f distance;
  cv::distanceTransform(framed, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  return distance(cv::Rect(1, 1, free.width(), free.height()));
}

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
  return cv::Mat1b(labels == largest);
}

/// The cheapest ways from one cell to all others of a part (Dijkstra's algorithm).
struct Ways {
  cv::Mat1d cost;
  cv::Mat1i before;    ///< index of the cell that the way comes from; -1 at its start
  cv::Point farthest;  ///< of the ends
};

Ways ways_from(const cv::Point& start, const cv::Mat1b& part, const cv::Mat1d& price,
               const cv::Mat1b& ends) {
  Ways ways{cv::Mat1d(part.size(), std::numeric_limits<double>::infinity()),
            cv::Mat1i(part.size(), -1), start};
  using Entry = std::pair<double, int>;  // equal costs: by index, the same everywhere
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  ways.cost(start) = 0.0;
  open.emplace(0.0, start.y * part.cols + start.x);
  while (!open.empty()) {
    const auto [cost, index] = open.top();
    open.pop();
    const cv::Point at(index % part.cols, index / part.cols);
    if (cost > ways.cost(at)) continue;
    if (ends(at) != 0) ways.farthest = at;  // cells leave the queue by rising cost
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const cv::Point next(at.x + dx, at.y + dy);
        if (next.x < 0 || next.y < 0 || next.x >= part.cols || next.y >= part.rows) continue;
        if (part(next) == 0) continue;
        const double step = std::hypot(dx, dy);
        const double total = cost + step * 0.5 * (price(at) + price(next));
        if (total >= ways.cost(next)) continue;
        ways.cost(next) = total;
        ways.before(next) = index;
        open.emplace(total, next.y * part.cols + next.x);
      }
    }
  }
  return ways;
}

}  // namespace

bool FreeGround::at(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d cell = (point - low) / cell_m;
  const int column = static_cast<int>(std::floor(cell.x()));
  const int row = static_cast<int>(std::floor(cell.y()));
  return free.contains(column, row) && free.at(column, row) != 0;
}

std::vector<Eigen::Vector2d> free_way(const FreeGround& ground) {
  const cv::Mat1f clearance = clearance_of(ground.free);
  const cv::Mat1b part = largest_part(cv::Mat1b(clearance >= kClearance / ground.cell_m));
  if (part.empty()) return {};
  cv::Mat1d price(part.size());
  for (int row = 0; row < part.rows; ++row) {
    for (int column = 0; column < part.cols; ++column) {
      const double near = kComfort / (ground.cell_m * std::max(clearance(row, column), 0.5F));
      price(row, column) = 1.0 + near * near;
    }
  }
  double widest = 0.0;
  cv::Point middle;
  cv::minMaxLoc(clearance, nullptr, &widest, nullptr, &middle, part);
  const cv::Mat1b ends(part & cv::Mat(clearance >= std::min(kEnd / ground.cell_m, widest)));
  const cv::Point end = ways_from(middle, part, price, ends).farthest;
  const Ways ways = ways_from(end, part, price, ends);
  std::vector<cv::Point> way;
  for (cv::Point at = ways.farthest;;) {
    way.push_back(at);
    const int before = ways.before(at);
    if (before < 0) break;
    at = {before % part.cols, before / part.cols};
  }
  std::vector<cv::Point> corners;
  cv::approxPolyDP(way, corners, kStraight / ground.cell_m, false);
  if (corners.size() < 2) return {};
  std::vector<Eigen::Vector2d> places;
  for (const cv::Point& corner : corners) places.push_back(ground.middle(corner.x, corner.y));
  return places;
}

}  // namespace nadir::simulation
