// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/aerial_mapping/sfm/matching.hpp"
#include "nadir/aerial_mapping/sfm/model.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Poses of a group of photos laid out on a plane: each photo is turned level by its gimbal (or
/// taken to look straight down) and becomes a similarity of the plane; all of them together are
/// one linear system. The unit of length is arbitrary and the ground is at z = 0.
void lay_out(Model& model, const std::vector<std::size_t>& group,
             const std::vector<MappingPhoto>& photos, const std::vector<PhotoFeatures>& features,
             const std::vector<VerifiedPair>& pairs, const StopToken& stop);

/// How a model of arbitrary unit was brought to the map.
struct Placement {
  bool scale = false;     ///< metres
  bool position = false;  ///< by the photos' positions
  bool heading = false;
  double ground = 0.0;  ///< height of the plane that the photos were laid out on
};

/// Turns, scales and shifts a model whose z is up so that its cameras come to lie on their
/// positions (least squares, the worst left out), as far as there are any; heights above take-off
/// give the scale and gimbals the heading where there are not. Returns what could be fixed.
Placement place(Model& model, const std::vector<std::size_t>& group,
                const std::vector<MappingPhoto>& photos);

/// Photos in a line leave the turn about that line open: root mean square widths of the positions
/// along and across their main direction, metres; nothing where fewer than two have one.
std::optional<std::pair<double, double>> widths_of_positions(
    const std::vector<std::size_t>& group, const std::vector<MappingPhoto>& photos);

/// x' = scale * rotation * x + shift for all poses and points.
void transform(Model& model, double scale, const Eigen::Matrix3d& rotation,
               const Eigen::Vector3d& shift);

/// Turns the model so that the plane of its points (robust) is level, and shifts it to z = 0.
void level(Model& model);

/// The pose by the priors alone, looking at the ground at `ground`: of a photo with position and
/// attitude.
std::optional<Pose> pose_of_prior(const PhotoPrior& prior);

}  // namespace nadir::aerial
