// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/aerial_mapping/sfm/adjustment.hpp"
#include "nadir/aerial_mapping/sfm/model.hpp"

namespace nadir::aerial {

/// x' = scale * rotation * x + shift.
struct Similarity {
  double scale = 1.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();
};

/// The similarity that brings `from` to `to` with least squares (Umeyama 1991), never a mirror.
/// Nothing where the points lie on a line: the turn about it is open.
std::optional<Similarity> fit_similarity(const std::vector<Eigen::Vector3d>& from,
                                         const std::vector<Eigen::Vector3d>& to);

/// Finds the control points in the model from their marks and, with three or more, brings the
/// model onto them. True where it did. Points with fewer than two marks in known photos have no
/// part.
bool take_control_points(Model& model, AdjustmentState& state, const PhotoSet& set);

}  // namespace nadir::aerial
