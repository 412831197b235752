// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/path.hpp"

#include <algorithm>
#include <cmath>

#include "nadir/core/angle.hpp"

namespace nadir::simulation {
namespace {

constexpr double kBeyond = 1e4;  ///< how far the prolongations reach, metres

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

Eigen::Vector2d left_of(const Eigen::Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

Eigen::Vector2d direction_of(double yaw) { return {std::cos(yaw), std::sin(yaw)}; }

}  // namespace

Path::Path(std::span<const Eigen::Vector2d> corners, std::span<const double> radii_m, bool endless)
    : endless_(endless) {
  const std::size_t count = corners.size();
  Eigen::Vector2d from = corners[0];
  const Eigen::Vector2d first = (corners[1] - corners[0]).normalized();
  pieces_.push_back({0.0, 0.0, from, std::atan2(first.y(), first.x()), first, 0.0, from});
  for (std::size_t i = 1; i < count; ++i) {
    const Eigen::Vector2d in = (corners[i] - corners[i - 1]).normalized();
    if (i + 1 == count) {
      add((corners[i] - from).norm(), 0.0);
      break;
    }
    const Eigen::Vector2d out = (corners[i + 1] - corners[i]).normalized();
    const double turn = std::atan2(cross(in, out), in.dot(out));
    if (std::abs(turn) < 1e-9) continue;
    const double reach =
        0.49 * std::min((corners[i] - corners[i - 1]).norm(), (corners[i + 1] - corners[i]).norm());
    const double half = std::tan(0.5 * std::abs(turn));
    const double radius = std::min(radii_m[std::min(i, radii_m.size()) - 1], reach / half);
    const Eigen::Vector2d begin = corners[i] - in * (radius * half);
    add((begin - from).norm(), 0.0);
    add(radius * std::abs(turn), (turn > 0.0 ? 1.0 : -1.0) / radius);
    from = corners[i] + out * (radius * half);
  }
  pieces_.erase(pieces_.begin());
}

void Path::add(double length, double bend) {
  Piece piece;
  const PathPose pose = at(length_);
  piece.start = length_;
  piece.length = length;
  piece.point = pose.point;
  piece.yaw = pose.yaw;
  piece.direction = direction_of(pose.yaw);
  piece.bend = bend;
  if (bend != 0.0) piece.centre = pose.point + left_of(piece.direction) / bend;
  pieces_.push_back(piece);
  length_ += length;
}

PathPose Path::at(double along) const {
  const Piece* piece = &pieces_.front();
  for (const Piece& next : pieces_) {
    if (next.start <= along) piece = &next;
  }
  double on = along - piece->start;
  const double beyond = on < 0.0 ? on : std::max(on - piece->length, 0.0);
  on -= beyond;
  PathPose pose{piece->point, piece->yaw};
  if (piece->bend == 0.0) {
    pose.point += piece->direction * on;
  } else {
    pose.yaw += on * piece->bend;
    pose.point = piece->centre - left_of(direction_of(pose.yaw)) / piece->bend;
  }
  pose.point += direction_of(pose.yaw) * beyond;
  return pose;
}

Eigen::Vector2d Path::place(PathPoint point) const {
  const PathPose pose = at(point.along);
  return pose.point + left_of(direction_of(pose.yaw)) * point.across;
}

PathPoint Path::locate_on(const Piece& piece, const Eigen::Vector2d& point, double low,
                          double high) {
  if (piece.bend == 0.0) {
    const Eigen::Vector2d offset = point - piece.point;
    const double along = offset.dot(piece.direction);
    const double across = cross(piece.direction, offset);
    const double clamped = std::clamp(along, low, high);
    if (clamped == along) return {piece.start + along, across};
    const double beyond = along - clamped;
    const double distance = std::sqrt(beyond * beyond + across * across);
    return {piece.start + clamped, std::copysign(distance, across)};
  }
  const Eigen::Vector2d spoke = point - piece.centre;
  const double radius = 1.0 / std::abs(piece.bend);
  const Eigen::Vector2d start = piece.point - piece.centre;
  const double swept = std::atan2(cross(start, spoke), start.dot(spoke));
  const double along = swept / piece.bend;
  const double across = (piece.bend > 0.0 ? 1.0 : -1.0) * (radius - spoke.norm());
  if (along >= low && along <= high) return {piece.start + along, across};
  const double clamped = std::abs(along - low) < std::abs(along - high) ? low : high;
  const double yaw = piece.yaw + clamped * piece.bend;
  const Eigen::Vector2d end = piece.centre - left_of(direction_of(yaw)) / piece.bend;
  const double side = cross(direction_of(yaw), point - end);
  return {piece.start + clamped, std::copysign((point - end).norm(), side)};
}

/// A bound from below, cheap.
double Path::least_distance(const Piece& piece, const Eigen::Vector2d& point) {
  if (piece.bend == 0.0) return std::abs(cross(piece.direction, point - piece.point));
  const double beyond = (point - piece.centre).norm() - 1.0 / std::abs(piece.bend);
  return std::abs(beyond);
}

PathPoint Path::locate(const Eigen::Vector2d& point) const {
  PathPoint best;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    if (least_distance(piece, point) >= std::abs(best.across)) continue;
    const bool reaches = endless_ && piece.bend == 0.0;
    const double low = reaches && i == 0 ? -kBeyond : 0.0;
    const double high = reaches && i + 1 == pieces_.size() ? kBeyond : piece.length;
    const PathPoint here = locate_on(piece, point, low, high);
    if (std::abs(here.across) < std::abs(best.across)) best = here;
  }
  return best;
}

}  // namespace nadir::simulation
