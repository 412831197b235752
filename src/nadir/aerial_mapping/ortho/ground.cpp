// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/ortho/ground.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "nadir/aerial_mapping/detail/median.hpp"

namespace nadir::aerial {
namespace {

constexpr double kPointsPerBin = 4.0;
constexpr std::size_t kFewestNeighbours = 6;
constexpr double kScatter = 4.0 * 1.4826;  // robust standard deviations
constexpr float kUnknown = std::numeric_limits<float>::lowest();
constexpr float kBeyond = 1e6F;  // metres; finite, for it is interpolated
constexpr double kSpan = 4.0;    // longest side of a triangle, in largest distances
constexpr double kAboutM = 5.0;  // reach of what says how high the ground goes on
constexpr double kSteep = 0.7;   // slope (35 degrees) that loose ground does not keep
constexpr double kStepM = 0.5;   // rise of a steep triangle that is taken for a step

Ground empty_ground(const Extent& extent, double cell_m) {
  Ground ground;
  const int width = std::max(1, static_cast<int>(std::ceil((extent.east - extent.west) / cell_m)));
  const int height =
      std::max(1, static_cast<int>(std::ceil((extent.north - extent.south) / cell_m)));
  ground.heights.height_m = Raster<float>(width, height, kUnknown);
  ground.heights.geo = {extent.west, extent.north, cell_m, {}};
  ground.ramp_m = ground.heights.height_m;
  ground.distance_m = Raster<float>(width, height, 0.0F);
  ground.span_m = Raster<float>(width, height, kBeyond);
  return ground;
}

double bilinear(const Raster<float>& raster, const GeoReference& geo, double x, double y) {
  const PixelCoordinate p = geo.pixel_at(x, y);
  const double column = std::clamp(p.column - 0.5, 0.0, raster.width() - 1.0);
  const double row = std::clamp(p.row - 0.5, 0.0, raster.height() - 1.0);
  const int c0 = static_cast<int>(column);
  const int r0 = static_cast<int>(row);
  const int c1 = std::min(c0 + 1, raster.width() - 1);
  const int r1 = std::min(r0 + 1, raster.height() - 1);
  const double fc = column - c0;
  const double fr = row - r0;
  return (1.0 - fr) * ((1.0 - fc) * raster.at(c0, r0) + fc * raster.at(c1, r0)) +
         fr * ((1.0 - fc) * raster.at(c0, r1) + fc * raster.at(c1, r1));
}

/// One point a cell, at the median height of the cell's points.
std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points,
                                     const GeoReference& geo) {
  std::map<std::pair<int, int>, std::vector<Eigen::Vector3d>> cells;
  for (const Eigen::Vector3d& p : points) {
    const PixelCoordinate at = geo.pixel_at(p.x(), p.y());
    cells[{static_cast<int>(std::floor(at.row)), static_cast<int>(std::floor(at.column))}]
        .push_back(p);
  }
  std::vector<Eigen::Vector3d> kept;
  for (auto& [cell, members] : cells) {
    std::stable_sort(members.begin(), members.end(),
                     [](const auto& a, const auto& b) { return a.z() < b.z(); });
    kept.push_back(members[members.size() / 2]);
  }
  return kept;
}

using Triangle = std::array<Eigen::Vector3d, 3>;  // column, row (continuous), height

std::vector<Triangle> delaunay(const std::vector<Eigen::Vector3d>& points, const GeoReference& geo,
                               int width, int height) {
  // Subdiv2D keeps floats: pixel coordinates are small enough for them, map coordinates are not.
  cv::Subdiv2D subdivision(cv::Rect(-2, -2, width + 4, height + 4));
  std::map<std::pair<float, float>, double> height_of;
  for (const Eigen::Vector3d& p : points) {
    const PixelCoordinate at = geo.pixel_at(p.x(), p.y());
    const cv::Point2f pixel(static_cast<float>(at.column), static_cast<float>(at.row));
    if (pixel.x < -1 || pixel.y < -1 || pixel.x > static_cast<float>(width + 1) ||
        pixel.y > static_cast<float>(height + 1))
      continue;
    if (height_of.emplace(std::pair(pixel.x, pixel.y), p.z()).second) subdivision.insert(pixel);
  }
  std::vector<cv::Vec6f> list;
  subdivision.getTriangleList(list);
  std::vector<Triangle> triangles;
  for (const cv::Vec6f& t : list) {
    Triangle triangle;
    bool real = true;  // its corners are points of ours, not of the frame
    for (int k = 0; k < 3 && real; ++k) {
      const auto found = height_of.find({t[2 * k], t[2 * k + 1]});
      real = found != height_of.end();
      if (real)
        triangle[static_cast<std::size_t>(k)] = {static_cast<double>(t[2 * k]),
                                                 static_cast<double>(t[2 * k + 1]), found->second};
    }
    if (real) triangles.push_back(triangle);
  }
  return triangles;
}

/// Whether a triangle joins the foot and the top of a step; `cell_m` is the unit of its columns and
/// rows.
bool is_step(const Triangle& t, double cell_m) {
  const auto [lowest, highest] = std::minmax({t[0].z(), t[1].z(), t[2].z()});
  const Eigen::Vector3d normal = (t[1] - t[0]).cross(t[2] - t[0]);
  return highest - lowest > kStepM &&
         normal.head<2>().norm() > kSteep * cell_m * std::abs(normal.z());
}

void fill(const Triangle& t, Ground& ground) {
  Raster<float>& heights = ground.heights.height_m;
  const double area =
      (t[1].x() - t[0].x()) * (t[2].y() - t[0].y()) - (t[2].x() - t[0].x()) * (t[1].y() - t[0].y());
  if (std::abs(area) < 1e-9) return;
  const auto [left, right] = std::minmax({t[0].x(), t[1].x(), t[2].x()});
  const auto [top, bottom] = std::minmax({t[0].y(), t[1].y(), t[2].y()});
  const int c0 = std::max(0, static_cast<int>(std::floor(left - 0.5)));
  const int c1 = std::min(heights.width() - 1, static_cast<int>(std::ceil(right)));
  const int r0 = std::max(0, static_cast<int>(std::floor(top - 0.5)));
  const int r1 = std::min(heights.height() - 1, static_cast<int>(std::ceil(bottom)));
  constexpr double kEdge = -1e-6;
  const double longest = std::max({(t[0] - t[1]).head<2>().norm(), (t[1] - t[2]).head<2>().norm(),
                                   (t[2] - t[0]).head<2>().norm()});
  const auto span = static_cast<float>(longest * ground.heights.geo.resolution);
  const bool step = is_step(t, ground.heights.geo.resolution);
  const double foot = std::min({t[0].z(), t[1].z(), t[2].z()});
  for (int row = r0; row <= r1; ++row)
    for (int column = c0; column <= c1; ++column) {
      const double x = column + 0.5;
      const double y = row + 0.5;
      const double b =
          ((x - t[0].x()) * (t[2].y() - t[0].y()) - (t[2].x() - t[0].x()) * (y - t[0].y())) / area;
      const double c =
          ((t[1].x() - t[0].x()) * (y - t[0].y()) - (x - t[0].x()) * (t[1].y() - t[0].y())) / area;
      if (b < kEdge || c < kEdge || b + c > 1.0 - kEdge) continue;
      const double z = t[0].z() + b * (t[1].z() - t[0].z()) + c * (t[2].z() - t[0].z());
      ground.ramp_m.at(column, row) = static_cast<float>(z);
      heights.at(column, row) = static_cast<float>(step ? foot : z);
      ground.span_m.at(column, row) = span;
    }
}

cv::Mat view_of(Raster<float>& raster) {
  return {raster.height(), raster.width(), CV_32F, raster.values().data()};
}

/// Of the known heights about a cell.
struct Usual {
  float height = 0.0F;  ///< median
  bool level = true;    ///< most of them differ by less than a step
};
Usual usual_about(const Raster<float>& heights, const cv::Mat& unknown, const cv::Point& cell,
                  int reach) {
  std::vector<float> near;
  const cv::Rect window = cv::Rect(cell.x - reach, cell.y - reach, 2 * reach + 1, 2 * reach + 1) &
                          cv::Rect(0, 0, heights.width(), heights.height());
  for (int row = window.y; row < window.y + window.height; ++row)
    for (int column = window.x; column < window.x + window.width; ++column)
      if (unknown.at<std::uint8_t>(row, column) == 0) near.push_back(heights.at(column, row));
  std::sort(near.begin(), near.end());
  const std::size_t tenth = near.size() / 10;
  return {near[near.size() / 2], near[near.size() - 1 - tenth] - near[tenth] < kStepM};
}

/// Beyond the triangles the ground goes on at the usual height about the nearest cell inside: that
/// one by itself may be a crown, or a point of two photos at the rim that is wrong. Where a step is
/// near it is unknown which height goes on.
void extrapolate(Ground& ground) {
  Raster<float>& heights = ground.heights.height_m;
  cv::Mat unknown(heights.height(), heights.width(), CV_8U);
  for (int row = 0; row < heights.height(); ++row)
    for (int column = 0; column < heights.width(); ++column)
      unknown.at<std::uint8_t>(row, column) = heights.at(column, row) == kUnknown ? 1 : 0;
  cv::Mat distance;
  cv::Mat labels;
  cv::distanceTransform(unknown, distance, labels, cv::DIST_L2, 5, cv::DIST_LABEL_PIXEL);
  std::map<int, cv::Point> cell_of_label;
  for (int row = 0; row < heights.height(); ++row)
    for (int column = 0; column < heights.width(); ++column)
      if (unknown.at<std::uint8_t>(row, column) == 0)
        cell_of_label[labels.at<int>(row, column)] = {column, row};
  const int reach = static_cast<int>(std::ceil(kAboutM / ground.heights.geo.resolution));
  std::map<int, Usual> usual_of_label;
  for (int row = 0; row < heights.height(); ++row)
    for (int column = 0; column < heights.width(); ++column) {
      if (unknown.at<std::uint8_t>(row, column) == 0) continue;
      const auto cell = cell_of_label.find(labels.at<int>(row, column));
      if (cell == cell_of_label.end()) continue;
      const auto [usual, is_new] = usual_of_label.try_emplace(cell->first);
      if (is_new) usual->second = usual_about(ground.ramp_m, unknown, cell->second, reach);
      heights.at(column, row) = usual->second.height;
      ground.ramp_m.at(column, row) = usual->second.height;
      if (!usual->second.level) ground.distance_m.at(column, row) = kBeyond;
    }
}

void set_distances(const std::vector<Eigen::Vector3d>& points, Ground& ground) {
  cv::Mat away(ground.distance_m.height(), ground.distance_m.width(), CV_8U, cv::Scalar(1));
  for (const Eigen::Vector3d& p : points) {
    const PixelCoordinate at = ground.heights.geo.pixel_at(p.x(), p.y());
    const int column = static_cast<int>(std::floor(at.column));
    const int row = static_cast<int>(std::floor(at.row));
    if (ground.distance_m.contains(column, row)) away.at<std::uint8_t>(row, column) = 0;
  }
  cv::Mat distance;
  cv::distanceTransform(away, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  cv::Mat to = view_of(ground.distance_m);
  distance.convertTo(to, CV_32F, ground.heights.geo.resolution);
}

}  // namespace

double Ground::height_at(double x, double y) const {
  return bilinear(heights.height_m, heights.geo, x, y);
}

double Ground::ramp_at(double x, double y) const { return bilinear(ramp_m, heights.geo, x, y); }

double Ground::distance_at(double x, double y) const {
  return bilinear(distance_m, heights.geo, x, y);
}

bool Ground::is_known(int column, int row, double max_distance_m) const {
  return distance_m.at(column, row) <= max_distance_m ||
         span_m.at(column, row) <= kSpan * max_distance_m;
}

bool Ground::is_known_at(double x, double y, double max_distance_m) const {
  const PixelCoordinate at = heights.geo.pixel_at(x, y);
  const int column = std::clamp(static_cast<int>(std::floor(at.column)), 0, distance_m.width() - 1);
  const int row = std::clamp(static_cast<int>(std::floor(at.row)), 0, distance_m.height() - 1);
  return is_known(column, row, max_distance_m);
}

std::vector<Eigen::Vector3d> without_outliers(std::vector<Eigen::Vector3d> points,
                                              double tolerance_m) {
  if (points.size() < 20) return points;
  Eigen::Vector3d low = points[0];
  Eigen::Vector3d high = points[0];
  for (const Eigen::Vector3d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double area = std::max(1e-9, (high.x() - low.x()) * (high.y() - low.y()));
  const double bin = std::sqrt(area * kPointsPerBin / static_cast<double>(points.size()));
  const auto bin_of = [&](const Eigen::Vector3d& p) {
    return std::pair(static_cast<int>((p.y() - low.y()) / bin),
                     static_cast<int>((p.x() - low.x()) / bin));
  };
  std::map<std::pair<int, int>, std::vector<double>> bins;
  for (const Eigen::Vector3d& p : points) bins[bin_of(p)].push_back(p.z());
  std::vector<Eigen::Vector3d> kept;
  for (const Eigen::Vector3d& p : points) {
    const auto [row, column] = bin_of(p);
    std::vector<double> near;
    for (int r = row - 1; r <= row + 1; ++r)
      for (int c = column - 1; c <= column + 1; ++c)
        if (const auto found = bins.find({r, c}); found != bins.end())
          near.insert(near.end(), found->second.begin(), found->second.end());
    if (near.size() < kFewestNeighbours) continue;  // alone: nothing vouches for it
    const double middle = median_of(near);
    for (double& z : near) z = std::abs(z - middle);
    if (std::abs(p.z() - middle) <= std::max(tolerance_m, kScatter * median_of(near)))
      kept.push_back(p);
  }
  return kept;
}

Ground triangulated_ground(const std::vector<Eigen::Vector3d>& points, const Extent& extent,
                           double cell_m) {
  Ground ground = empty_ground(extent, cell_m);
  const std::vector<Eigen::Vector3d> few = thinned(points, ground.heights.geo);
  Raster<float>& heights = ground.heights.height_m;
  const auto triangles = delaunay(few, ground.heights.geo, heights.width(), heights.height());
  if (triangles.empty()) return plane_ground(points, extent, cell_m, 0.0);
  for (const Triangle& triangle : triangles) fill(triangle, ground);
  set_distances(few, ground);
  extrapolate(ground);
  if (std::count(heights.values().begin(), heights.values().end(), kUnknown) > 0)
    return plane_ground(points, extent, cell_m, 0.0);
  for (Raster<float>* raster : {&heights, &ground.ramp_m}) {
    cv::Mat smooth;
    cv::Mat to = view_of(*raster);
    cv::medianBlur(to, smooth, 3);
    smooth.copyTo(to);
  }
  return ground;
}

Ground plane_ground(const std::vector<Eigen::Vector3d>& points, const Extent& extent, double cell_m,
                    double fallback) {
  Ground ground = empty_ground(extent, cell_m);
  const double x0 = 0.5 * (extent.west + extent.east);
  const double y0 = 0.5 * (extent.south + extent.north);
  Eigen::Vector3d plane{fallback, 0.0, 0.0};
  std::vector<double> weights(points.size(), 1.0);
  for (int pass = 0; pass < 10 && points.size() >= 3; ++pass) {
    Eigen::Matrix3d a = 1e-9 * Eigen::Matrix3d::Identity();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Eigen::Vector3d row{1.0, points[k].x() - x0, points[k].y() - y0};
      a += weights[k] * row * row.transpose();
      b += weights[k] * row * points[k].z();
    }
    plane = a.ldlt().solve(b);
    std::vector<double> residuals;
    for (const Eigen::Vector3d& p : points)
      residuals.push_back(
          std::abs(p.z() - plane.x() - plane.y() * (p.x() - x0) - plane.z() * (p.y() - y0)));
    const double sigma = std::max(1e-6, 1.5 * median_of(residuals));
    for (std::size_t k = 0; k < points.size(); ++k)
      weights[k] = 1.0 / (1.0 + residuals[k] * residuals[k] / (sigma * sigma));
  }
  const GeoReference& geo = ground.heights.geo;
  for (int row = 0; row < ground.heights.height(); ++row)
    for (int column = 0; column < ground.heights.width(); ++column)
      ground.heights.height_m.at(column, row) =
          static_cast<float>(plane.x() + plane.y() * (geo.x_at(column + 0.5) - x0) +
                             plane.z() * (geo.y_at(row + 0.5) - y0));
  ground.ramp_m = ground.heights.height_m;
  return ground;
}

}  // namespace nadir::aerial
