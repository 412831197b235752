// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/aerial_mapping/sfm/model.hpp"

namespace nadir::aerial {

struct TriangulationGates {
  double max_error_px = 4.0;
  double min_angle_deg = 1.5;  ///< between two of the rays
  int min_views = 2;
};

/// Finds the points of all tracks from the known poses, marks the observations that agree and
/// leaves the point invalid where too few do. Landmarks are independent: computed in parallel.
void triangulate(Model& model, const TriangulationGates& gates);

/// Points on the level plane at `ground`, the mean of where their rays meet it: the start that
/// poses known only roughly allow. Tracks whose rays part by more than `spread` are left invalid.
void place_on_plane(Model& model, double ground, double spread);

/// Root mean square and median of the errors of the used observations, pixels; 0 where none.
struct ReprojectionError {
  double rms = 0.0;
  double median = 0.0;
  int observations = 0;
  int points = 0;
};
ReprojectionError reprojection_error(const Model& model);

}  // namespace nadir::aerial
