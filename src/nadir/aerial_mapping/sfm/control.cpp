// SPDX-License-Identifier: Apache-2.0
#include "nadir/aerial_mapping/sfm/control.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>

#include "nadir/aerial_mapping/sfm/pose_start.hpp"
#include "nadir/aerial_mapping/sfm/triangulation.hpp"

namespace nadir::aerial {

std::optional<Similarity> fit_similarity(const std::vector<Eigen::Vector3d>& from,
                                         const std::vector<Eigen::Vector3d>& to) {
  if (from.size() < 3) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(from.size());
  Eigen::Matrix3Xd a(3, n);
  Eigen::Matrix3Xd b(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    a.col(k) = from[static_cast<std::size_t>(k)];
    b.col(k) = to[static_cast<std::size_t>(k)];
  }
  const Eigen::Matrix3Xd centred = b.colwise() - b.rowwise().mean();
  const Eigen::JacobiSVD<Eigen::Matrix3Xd> svd(centred);
  if (svd.singularValues()[1] < 0.02 * svd.singularValues()[0]) return std::nullopt;
  const Eigen::Matrix4d t = Eigen::umeyama(a, b, true);
  Similarity similarity;
  similarity.scale = t.topLeftCorner<3, 3>().col(0).norm();
  if (!(similarity.scale > 0.0) || !t.allFinite()) return std::nullopt;
  similarity.rotation = t.topLeftCorner<3, 3>() / similarity.scale;
  similarity.shift = t.topRightCorner<3, 1>();
  return similarity;
}

bool take_control_points(Model& model, AdjustmentState& state, const PhotoSet& set) {
  const std::size_t count = set.control_points.size();
  state.control.assign(count, Eigen::Vector3d::Zero());
  state.control_known.assign(count, 0);
  if (count == 0) return false;
  // As landmarks of their own, triangulated like the others but with the patience that a mark
  // clicked by hand needs.
  Model marks;
  marks.cameras = model.cameras;
  marks.camera_of = model.camera_of;
  marks.poses = model.poses;
  for (const GroundControlPoint& point : set.control_points) {
    Landmark landmark;
    for (const GroundControlPoint::Mark& mark : point.marks) {
      const auto photo = std::find_if(set.photos.begin(), set.photos.end(),
                                      [&](const auto& p) { return p.name == mark.photo; });
      if (photo != set.photos.end())
        landmark.track.push_back(
            {static_cast<std::size_t>(photo - set.photos.begin()), mark.u, mark.v});
    }
    marks.landmarks.push_back(std::move(landmark));
  }
  triangulate(marks, {20.0, 0.5, 2});
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (std::size_t i = 0; i < count; ++i) {
    if (!marks.landmarks[i].valid) continue;
    state.control[i] = marks.landmarks[i].position;
    state.control_known[i] = 1;
    from.push_back(state.control[i]);
    to.push_back(set.control_points[i].position.vector());
  }
  const auto similarity = fit_similarity(from, to);
  if (!similarity) {
    state.control_known.assign(count, 0);
    return false;
  }
  transform(model, similarity->scale, similarity->rotation, similarity->shift);
  for (std::size_t i = 0; i < count; ++i)
    state.control[i] =
        similarity->scale * (similarity->rotation * state.control[i]) + similarity->shift;
  // What the positions are off by, now that the control points hold the frame: their median.
  std::array<std::vector<double>, 3> off;
  for (std::size_t i = 0; i < set.photos.size(); ++i)
    if (model.poses[i].known && set.photos[i].prior.position)
      for (std::size_t k = 0; k < 3; ++k)
        off[k].push_back(model.poses[i].centre[static_cast<Eigen::Index>(k)] -
                         set.photos[i].prior.position->vector()[static_cast<Eigen::Index>(k)]);
  for (std::size_t k = 0; k < 3 && !off[k].empty(); ++k) {
    const auto middle = off[k].begin() + static_cast<std::ptrdiff_t>(off[k].size() / 2);
    std::nth_element(off[k].begin(), middle, off[k].end());
    state.position_bias[static_cast<Eigen::Index>(k)] = *middle;
  }
  state.ground = similarity->scale * state.ground + similarity->shift.z();
  return true;
}

}  // namespace nadir::aerial
