// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/ground_level.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

namespace nadir {
namespace {

/// Height above the ground from which a cell is a thing rather than ground, metres: above a kerb.
constexpr double kThing = 0.2;
constexpr int kRefits = 3;
/// The same above the lowest cell nearby, which may lie down a slope.
constexpr double kThingAboveLowest = 0.5;
/// How far that is, standard deviations of the window: a roof that is wider still weighs nothing
/// where the ground is.
constexpr double kReach = 3.0;
/// Keeps a slope from being read out of a row of cells: share of the moment of a full window.
constexpr double kSlopePrior = 1e-3;
/// Cells a standard deviation of the window: the plane is smooth, so few are enough.
constexpr double kCellsPerSigma = 5.0;

/// The heights on coarse cells of `side` pixels, which share the upper-left corner.
struct Cells {
  int side = 1;
  cv::Mat height;  ///< CV_64F; the median, so that a spike is no ground
  cv::Mat share;   ///< CV_64F; of the cell's pixels, known
};

Cells coarse_cells(const GreyImage& heights, double sigma_px) {
  Cells cells;
  cells.side = std::max(1, static_cast<int>(sigma_px / kCellsPerSigma));
  const int columns = (heights.value.width() + cells.side - 1) / cells.side;
  const int rows = (heights.value.height() + cells.side - 1) / cells.side;
  cells.height = cv::Mat::zeros(rows, columns, CV_64F);
  cells.share = cv::Mat::zeros(rows, columns, CV_64F);
  std::vector<float> known;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      known.clear();
      for (int j = row * cells.side; j < std::min((row + 1) * cells.side, heights.value.height());
           ++j) {
        for (int i = column * cells.side;
             i < std::min((column + 1) * cells.side, heights.value.width()); ++i) {
          if (heights.valid.at(i, j) != 0) known.push_back(heights.value.at(i, j));
        }
      }
      if (known.empty()) continue;
      const auto middle = known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2);
      std::nth_element(known.begin(), middle, known.end());
      cells.height.at<double>(row, column) = static_cast<double>(*middle);
      cells.share.at<double>(row, column) =
          static_cast<double>(known.size()) / (cells.side * cells.side);
    }
  }
  return cells;
}

/// height = level + east dx + south dy around each cell's centre, in cells.
struct Planes {
  cv::Mat level;
  cv::Mat east;
  cv::Mat south;
};

/// Gaussian sums of a weight and of what it weighs.
class Moments {
 public:
  Moments(cv::Mat weight, double sigma) : weight_(std::move(weight)), sigma_(sigma) {}
  cv::Mat of(const cv::Mat& value) const { return smooth(weight_.mul(value)); }
  cv::Mat sum() const { return smooth(weight_); }

 private:
  cv::Mat smooth(const cv::Mat& values) const {
    cv::Mat result;
    cv::GaussianBlur(values, result, {}, sigma_, sigma_, cv::BORDER_CONSTANT);
    return result;
  }
  cv::Mat weight_;
  double sigma_;
};

Planes fit_planes(const cv::Mat& height, const cv::Mat& weight, double sigma) {
  cv::Mat x(height.size(), CV_64F);
  cv::Mat y(height.size(), CV_64F);
  for (int row = 0; row < height.rows; ++row) {
    for (int column = 0; column < height.cols; ++column) {
      x.at<double>(row, column) = column;
      y.at<double>(row, column) = row;
    }
  }
  const Moments moments(weight, sigma);
  const cv::Mat m = moments.sum();
  const cv::Mat mx = moments.of(x);
  const cv::Mat my = moments.of(y);
  const cv::Mat mxx = moments.of(x.mul(x));
  const cv::Mat mxy = moments.of(x.mul(y));
  const cv::Mat myy = moments.of(y.mul(y));
  const cv::Mat mh = moments.of(height);
  const cv::Mat mxh = moments.of(x.mul(height));
  const cv::Mat myh = moments.of(y.mul(height));

  Planes planes;
  for (cv::Mat* part : {&planes.level, &planes.east, &planes.south}) {
    *part = cv::Mat::zeros(height.size(), CV_64F);
  }
  for (int row = 0; row < height.rows; ++row) {
    for (int column = 0; column < height.cols; ++column) {
      const auto at = [&](const cv::Mat& part) { return part.at<double>(row, column); };
      if (at(m) < 1e-12) continue;
      // Moments about the cell: sums over (q - p) from sums over q.
      const double dx = at(mx) - column * at(m);
      const double dy = at(my) - row * at(m);
      const double dxx = at(mxx) - 2.0 * column * at(mx) + column * column * at(m);
      const double dyy = at(myy) - 2.0 * row * at(my) + row * row * at(m);
      const double dxy =
          at(mxy) - column * at(my) - row * at(mx) + static_cast<double>(row) * column * at(m);
      const double prior = kSlopePrior * sigma * sigma * at(m);
      Eigen::Matrix3d normal;
      normal << at(m), dx, dy, dx, dxx + prior, dxy, dy, dxy, dyy + prior;
      const Eigen::Vector3d right{at(mh), at(mxh) - column * at(mh), at(myh) - row * at(mh)};
      const Eigen::Vector3d plane = normal.ldlt().solve(right);
      planes.level.at<double>(row, column) = plane.x();
      planes.east.at<double>(row, column) = plane.y();
      planes.south.at<double>(row, column) = plane.z();
    }
  }
  return planes;
}

/// Takes from each cell its say by its height above `ground`.
void weigh_down(cv::Mat& weight, const cv::Mat& height, const cv::Mat& ground, double thing_m) {
  for (int row = 0; row < weight.rows; ++row) {
    for (int column = 0; column < weight.cols; ++column) {
      const double above =
          std::max(height.at<double>(row, column) - ground.at<double>(row, column), 0.0);
      weight.at<double>(row, column) /= 1.0 + (above / thing_m) * (above / thing_m);
    }
  }
}

/// The lowest known height within reach.
cv::Mat lowest_nearby(const Cells& cells, double sigma) {
  cv::Mat known = cells.height.clone();
  known.setTo(std::numeric_limits<double>::max(), cells.share == 0.0);
  const int side = 2 * static_cast<int>(std::ceil(kReach * sigma)) + 1;
  cv::Mat lowest;
  cv::erode(known, lowest, cv::Mat::ones(1, side, CV_8U));
  cv::erode(lowest, lowest, cv::Mat::ones(side, 1, CV_8U));
  return lowest;
}

/// The planes of the four cells around a point, in cells, bilinear: exact on a slope.
double level_at(const Planes& planes, double x, double y) {
  const double left = std::floor(x);
  const double top = std::floor(y);
  double sum = 0.0;
  for (const int j : {0, 1}) {
    for (const int i : {0, 1}) {
      const double share =
          (i == 0 ? 1.0 - (x - left) : x - left) * (j == 0 ? 1.0 - (y - top) : y - top);
      const int column = std::clamp(static_cast<int>(left) + i, 0, planes.level.cols - 1);
      const int row = std::clamp(static_cast<int>(top) + j, 0, planes.level.rows - 1);
      sum += share * (planes.level.at<double>(row, column) +
                      planes.east.at<double>(row, column) * (x - column) +
                      planes.south.at<double>(row, column) * (y - row));
    }
  }
  return sum;
}

}  // namespace

Raster<float> ground_level(const GreyImage& heights, double sigma_px) {
  const Cells cells = coarse_cells(heights, sigma_px);
  const double sigma = sigma_px / cells.side;
  // A plane through roof and ground would be a slope: roofs lose their say before the first fit.
  cv::Mat prior = cells.share.clone();
  weigh_down(prior, cells.height, lowest_nearby(cells, sigma), kThingAboveLowest);
  Planes planes = fit_planes(cells.height, prior, sigma);
  for (int refit = 0; refit < kRefits; ++refit) {
    cv::Mat weight = prior.clone();
    weigh_down(weight, cells.height, planes.level, kThing);
    planes = fit_planes(cells.height, weight, sigma);
  }
  Raster<float> ground(heights.value.width(), heights.value.height());
  for (int row = 0; row < ground.height(); ++row) {
    for (int column = 0; column < ground.width(); ++column) {
      if (heights.valid.at(column, row) == 0) continue;
      ground.at(column, row) = static_cast<float>(
          level_at(planes, (column + 0.5) / cells.side - 0.5, (row + 0.5) / cells.side - 0.5));
    }
  }
  return ground;
}

}  // namespace nadir
