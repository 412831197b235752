// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nadir/aerial_mapping/aerial_map.hpp"
#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/photo_set.hpp"
#include "nadir/aerial_mapping/sfm/adjustment.hpp"
#include "nadir/aerial_mapping/sfm/matching.hpp"
#include "nadir/aerial_mapping/sfm/model.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Poses and points of the largest group of photos, and what can be said about them.
struct Reconstruction {
  Model model;
  /// Points for the surface: more than the adjustment trusts (sfm/guided.hpp).
  std::vector<Landmark> surface;
  AdjustmentState state;
  std::vector<std::vector<std::size_t>> components;  ///< the first is the one that is mapped
  ScaleSource scale_source = ScaleSource::kNone;
  double scale_sigma = 0.0;
  double heading_sigma_rad = 0.0;
  std::vector<double> focal_sigma;  ///< of ln f, a camera
  /// Where the positions lie on one straight line, which leaves the turn about it open: the
  /// standard deviation of what holds it, degrees, and whether that is the gimbals.
  std::optional<double> strip_turn_sigma_deg;
  bool strip_held_by_gimbals = false;
  bool focal_held = false;  ///< although it was to be free: nothing else would have held it
};

/// Cameras by their priors, no poses, tracks of the group's photos.
Model start_model(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                  const std::vector<VerifiedPair>& pairs, int min_inliers);

/// Finds the poses of the photos from their matches and priors. Throws Stopped, as the others do.
Reconstruction reconstruct(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                           const std::vector<VerifiedPair>& pairs,
                           const AerialMappingOptions& options, const StopToken& stop);

/// Takes the poses that the photos bring along and triangulates their tracks; adjusts them where
/// the options say so.
Reconstruction reconstruct_posed(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                                 const std::vector<VerifiedPair>& pairs,
                                 const AerialMappingOptions& options, const StopToken& stop);

/// What an earlier reconstruction of some of the photos found.
struct KnownPoses {
  std::map<std::string, Pose> poses;  ///< by the photos' names
  std::vector<CameraModel> cameras;   ///< as in the set, possibly fewer
  std::vector<double> readout_s;      ///< of the cameras
};

/// Adds the photos that have no pose yet to those that have: their poses from the points of the
/// others, then an adjustment of the new ones and their neighbours alone. For a map in the making:
/// no surface points of its own, no uncertainty.
Reconstruction reconstruct_next(const PhotoSet& set, const std::vector<PhotoFeatures>& features,
                                const std::vector<VerifiedPair>& pairs,
                                const AerialMappingOptions& options, const KnownPoses& known,
                                const StopToken& stop);

}  // namespace nadir::aerial
