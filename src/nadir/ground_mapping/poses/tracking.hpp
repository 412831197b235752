// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/ground_mapping/depth/sighting.hpp"

namespace nadir::ground {

/// camera_from_camera of two instants: coordinates at the first to those at the second.
using CameraStep = Transform3<frames::Camera, frames::Camera>;

inline Eigen::Vector3d moved(const CameraStep& step, const Eigen::Vector3d& p) {
  return step.rotation * p + step.translation;
}

/// A landmark of one sighting that was found in the image of another.
struct Track {
  Eigen::Vector3d p_in_first;
  Eigen::Vector2d pixel;  ///< in the second image
};

/// Looks for the landmarks of `first` in `second` by correlation: where `expected` leads them, and,
/// if they are not there, around where they were. What is found nowhere is left out.
std::vector<Track> track(const Sighting& first, const Sighting& second, const CameraStep& expected);

/// The distance of the tracks from where a step leads their landmarks, pixels, that `share` of them
/// stay below; a landmark that it leads behind the camera counts as off by the image's width. NaN
/// without tracks.
double offset_of(const std::vector<Track>& tracks, const CameraModel& camera,
                 const CameraStep& step, double share);

}  // namespace nadir::ground
