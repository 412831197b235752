// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "nadir/core/frames.hpp"
#include "nadir/evaluation/association.hpp"
#include "nadir/evaluation/evaluation_options.hpp"

namespace nadir {

/// Takes an estimated pose to an aligned one: x -> scale * R x + t, yaw -> yaw + rotation.
struct Similarity2 {
  double scale = 1.0;
  Transform2<frames::Map, frames::Map> motion;

  Pose2 operator*(const Pose2& pose) const {
    return motion * Pose2{scale * pose.x, scale * pose.y, pose.yaw};
  }
};

/// The alignment of the estimates onto the truths; identity for `kNone` and for no pair. Throws
/// Error (processing) where the estimated positions coincide and no rotation follows from them.
/// Source: S. Umeyama, "Least-squares estimation of transformation parameters between two point
/// patterns", TPAMI 1991, equations 40 to 43, in the plane.
Similarity2 align(std::span<const PosePair> pairs, Alignment alignment);

}  // namespace nadir
