// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/guided.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nadir::aerial {
namespace {

constexpr double kStripHalfPx = 2.0;
constexpr float kStripRatio = 0.8F;       // against the second best of the strip
constexpr float kLargestSquared = 0.30F;  // of the distance of two RootSIFT descriptors
constexpr float kSizeRatio = 1.6F;        // the photos are taken from about the same height
constexpr int kBinPx = 32;

/// Features by place.
class Bins {
 public:
  Bins(const PhotoFeatures& features, const CameraModel& camera)
      : columns_(camera.width / kBinPx + 1), rows_(camera.height / kBinPx + 1) {
    bins_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
    for (std::size_t i = 0; i < features.points.size(); ++i) {
      const int column = bin(features.points[i].u, columns_);
      const int row = bin(features.points[i].v, rows_);
      const int at = row * columns_ + column;
      bins_[static_cast<std::size_t>(at)].push_back(static_cast<int>(i));
    }
  }

  template <class Visit>
  void visit(double left, double top, double right, double bottom, const Visit& each) const {
    for (int row = bin(top, rows_); row <= bin(bottom, rows_); ++row)
      for (int column = bin(left, columns_); column <= bin(right, columns_); ++column) {
        const int at = row * columns_ + column;
        for (const int i : bins_[static_cast<std::size_t>(at)]) each(i);
      }
  }

 private:
  static int bin(double pixel, int count) {
    return static_cast<int>(std::clamp(pixel / kBinPx, 0.0, count - 1.0));
  }
  int columns_;
  int rows_;
  std::vector<std::vector<int>> bins_;
};

float squared_distance(const cv::Mat& a, int i, const cv::Mat& b, int j) {
  const auto* p = a.ptr<float>(i);
  const auto* q = b.ptr<float>(j);
  float sum = 0.0F;
  for (int k = 0; k < a.cols; ++k) sum += (p[k] - q[k]) * (p[k] - q[k]);
  return sum;
}

/// Ends of the segment, in the other photo, on which a feature may lie.
struct Strip {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();

  double distance(const Eigen::Vector2d& p) const {
    const Eigen::Vector2d along = to - from;
    const double length = along.squaredNorm();
    const double t = length > 0.0 ? std::clamp((p - from).dot(along) / length, 0.0, 1.0) : 0.0;
    return (p - from - t * along).norm();
  }
};

bool strip_of(const Model& model, std::size_t photo, std::size_t other, const Feature& feature,
              double lowest, double highest, Strip& strip) {
  const Eigen::Vector3d ray =
      model.direction(photo, static_cast<double>(feature.u), static_cast<double>(feature.v));
  const Eigen::Vector3d centre = model.centre_at(photo, static_cast<double>(feature.v));
  if (ray.z() > -0.2 || highest >= centre.z()) return false;
  const auto far = model.project(other, centre + ray * ((lowest - centre.z()) / ray.z()));
  const auto near = model.project(other, centre + ray * ((highest - centre.z()) / ray.z()));
  if (!far || !near) return false;
  strip = {*far, *near};
  const CameraModel& camera = model.camera(other);
  const auto outside = [&](const Eigen::Vector2d& p) {
    return p.x() < 0.0 || p.y() < 0.0 || p.x() > camera.width || p.y() > camera.height;
  };
  return !outside(*far) || !outside(*near);
}

/// For each feature of `photo` its best and clearly best partner in `other`, -1 where there is
/// none.
std::vector<int> partners(const Model& model, std::size_t photo, std::size_t other,
                          const PhotoFeatures& from, const PhotoFeatures& to, const Bins& bins,
                          double lowest, double highest) {
  std::vector<int> partner(from.points.size(), -1);
  for (std::size_t i = 0; i < from.points.size(); ++i) {
    Strip strip;
    if (!strip_of(model, photo, other, from.points[i], lowest, highest, strip)) continue;
    float best = std::numeric_limits<float>::infinity();
    float second = best;
    int best_index = -1;
    const auto consider = [&](int j) {
      const Feature& q = to.points[static_cast<std::size_t>(j)];
      const float ratio = q.size / from.points[i].size;
      if (ratio > kSizeRatio || ratio < 1.0F / kSizeRatio) return;
      if (strip.distance({static_cast<double>(q.u), static_cast<double>(q.v)}) > kStripHalfPx)
        return;
      const float distance =
          squared_distance(from.descriptors, static_cast<int>(i), to.descriptors, j);
      if (distance < best) {
        // The same place with another main direction is no rival.
        const bool same =
            best_index >= 0 &&
            std::hypot(q.u - to.points[static_cast<std::size_t>(best_index)].u,
                       q.v - to.points[static_cast<std::size_t>(best_index)].v) < 1.5F;
        if (!same) second = best;
        best = distance;
        best_index = j;
      } else if (distance < second) {
        const Feature& b = to.points[static_cast<std::size_t>(best_index)];
        if (std::hypot(q.u - b.u, q.v - b.v) >= 1.5F) second = distance;
      }
    };
    bins.visit(std::min(strip.from.x(), strip.to.x()) - kStripHalfPx,
               std::min(strip.from.y(), strip.to.y()) - kStripHalfPx,
               std::max(strip.from.x(), strip.to.x()) + kStripHalfPx,
               std::max(strip.from.y(), strip.to.y()) + kStripHalfPx, consider);
    if (best_index >= 0 && best < kLargestSquared && best < kStripRatio * kStripRatio * second)
      partner[i] = best_index;
  }
  return partner;
}

}  // namespace

void rematch(const Model& model, const std::vector<PhotoFeatures>& features, double lowest,
             double highest, std::vector<VerifiedPair>& pairs, const StopToken& stop) {
  std::vector<Bins> bins;
  bins.reserve(features.size());
  for (std::size_t i = 0; i < features.size(); ++i) bins.emplace_back(features[i], model.camera(i));
  tbb::parallel_for(std::size_t{0}, pairs.size(), [&](std::size_t n) {
    stop.check();
    VerifiedPair& pair = pairs[n];
    if (!model.poses[pair.first].known || !model.poses[pair.second].known) return;
    const PhotoFeatures& first = features[pair.first];
    const PhotoFeatures& second = features[pair.second];
    const auto forth =
        partners(model, pair.first, pair.second, first, second, bins[pair.second], lowest, highest);
    const auto back =
        partners(model, pair.second, pair.first, second, first, bins[pair.first], lowest, highest);
    FeatureMatches found;
    for (std::size_t i = 0; i < forth.size(); ++i)
      if (forth[i] >= 0 && back[static_cast<std::size_t>(forth[i])] == static_cast<int>(i))
        found.emplace_back(static_cast<int>(i), forth[i]);
    if (found.size() > pair.inliers.size()) pair.inliers = std::move(found);
  });
}

}  // namespace nadir::aerial
