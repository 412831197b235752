// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/height_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace nadir::simulation {
namespace {

constexpr int kBlockNodes = 8;       ///< nodes a side
constexpr double kTolerance = 1e-4;  ///< metres of height

int clamped(double index, int count) {
  return static_cast<int>(std::clamp(index, 0.0, static_cast<double>(count - 1)));
}

}  // namespace

HeightField::HeightField(Raster<float> nodes, Eigen::Vector2d low, double spacing)
    : nodes_(std::move(nodes)), low_(std::move(low)), spacing_(spacing) {
  const int width = nodes_.width();
  const int height = nodes_.height();
  blocks_ = Raster<Block>((width + kBlockNodes - 1) / kBlockNodes,
                          (height + kBlockNodes - 1) / kBlockNodes);
  for (int row = 0; row < blocks_.height(); ++row) {
    for (int column = 0; column < blocks_.width(); ++column) {
      Block block{std::numeric_limits<float>::lowest(), 0.0F};
      float steepest = 0.0F;
      // One node more on every side: a bilinear patch reaches over the border of its block.
      for (int r = std::max(row * kBlockNodes - 1, 0);
           r <= std::min((row + 1) * kBlockNodes, height - 1); ++r) {
        for (int c = std::max(column * kBlockNodes - 1, 0);
             c <= std::min((column + 1) * kBlockNodes, width - 1); ++c) {
          const float here = nodes_.at(c, r);
          block.top = std::max(block.top, here);
          if (c + 1 < width) steepest = std::max(steepest, std::abs(nodes_.at(c + 1, r) - here));
          if (r + 1 < height) steepest = std::max(steepest, std::abs(nodes_.at(c, r + 1) - here));
        }
      }
      block.slope = 1.415F * steepest / static_cast<float>(spacing_);
      blocks_.at(column, row) = block;
    }
  }
}

Eigen::Vector2d HeightField::high() const {
  return low_ + spacing_ * Eigen::Vector2d(nodes_.width(), nodes_.height());
}

double HeightField::at(double x, double y) const {
  const double u = std::clamp((x - low_.x()) / spacing_ - 0.5, 0.0, nodes_.width() - 1.001);
  const double v = std::clamp((y - low_.y()) / spacing_ - 0.5, 0.0, nodes_.height() - 1.001);
  const int column = static_cast<int>(u);
  const int row = static_cast<int>(v);
  const double a = u - column;
  const double b = v - row;
  const float* south = &nodes_.at(column, row);
  const float* north = south + nodes_.width();
  const double below = south[0] + a * (south[1] - south[0]);
  const double above = north[0] + a * (north[1] - north[0]);
  return below + b * (above - below);
}

Eigen::Vector3d HeightField::normal(double x, double y) const {
  const double h = spacing_;
  return Eigen::Vector3d(at(x - h, y) - at(x + h, y), at(x, y - h) - at(x, y + h), 2.0 * h)
      .normalized();
}

double HeightField::top(const Eigen::Vector2d& low, const Eigen::Vector2d& high) const {
  const double size = spacing_ * kBlockNodes;
  double top = std::numeric_limits<double>::lowest();
  const int last_column = clamped((high.x() - low_.x()) / size, blocks_.width());
  const int last_row = clamped((high.y() - low_.y()) / size, blocks_.height());
  for (int row = clamped((low.y() - low_.y()) / size, blocks_.height()); row <= last_row; ++row) {
    for (int column = clamped((low.x() - low_.x()) / size, blocks_.width()); column <= last_column;
         ++column) {
      top = std::max(top, static_cast<double>(blocks_.at(column, row).top));
    }
  }
  return top;
}

double HeightField::refine(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                           double above, double below) const {
  const auto gap = [&](double t) {
    return origin.z() + t * direction.z() -
           at(origin.x() + t * direction.x(), origin.y() + t * direction.y());
  };
  double gap_above = gap(above);
  double gap_below = gap(below);
  for (int i = 0; i < 30 && below - above > 1e-9; ++i) {
    // The secant, or the middle where it would creep along one end.
    const double share = gap_above > gap_below ? gap_above / (gap_above - gap_below) : 0.5;
    const double t = above + (i % 3 == 2 ? 0.5 : std::clamp(share, 0.01, 0.99)) * (below - above);
    const double middle = gap(t);
    if (std::abs(middle) < kTolerance) return t;
    if (middle > 0.0) {
      above = t;
      gap_above = middle;
    } else {
      below = t;
      gap_below = middle;
    }
  }
  return below;
}

double HeightField::meet(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         double from, double to) const {
  const double run = std::hypot(direction.x(), direction.y());
  const double size = spacing_ * kBlockNodes;
  const double least = 0.2 * spacing_ / (run + std::abs(direction.z()));
  const auto exit_of = [&](double position, double speed, int block, double low) {
    if (std::abs(speed) < 1e-12) return std::numeric_limits<double>::infinity();
    return (low + (block + (speed > 0.0 ? 1 : 0)) * size - position) / speed;
  };
  double t = from;
  double before = from;
  while (t <= to) {
    const Eigen::Vector3d p = origin + t * direction;
    const int column = clamped((p.x() - low_.x()) / size, blocks_.width());
    const int row = clamped((p.y() - low_.y()) / size, blocks_.height());
    const Block& block = blocks_.at(column, row);
    const double leaves = t + std::max(std::min(exit_of(p.x(), direction.x(), column, low_.x()),
                                                exit_of(p.y(), direction.y(), row, low_.y())),
                                       0.0);
    const double out = std::min(leaves, to);
    if (std::min(p.z(), origin.z() + out * direction.z()) > block.top) {
      before = t;
      if (leaves >= to) return std::numeric_limits<double>::quiet_NaN();
      t = leaves + least * 0.05;
      continue;
    }
    const double gap = p.z() - at(p.x(), p.y());
    if (gap <= kTolerance) return gap >= -kTolerance ? t : refine(origin, direction, before, t);
    before = t;
    // No step can pass the surface while it is as short as the block's steepest slope asks.
    const double closing = block.slope * run - direction.z();
    const double safe = closing > 0.0 ? gap / closing : leaves - t;
    t = std::min(t + std::max(safe, least), leaves + least * 0.05);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace nadir::simulation
