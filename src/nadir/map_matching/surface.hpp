// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "nadir/map_matching/matching.hpp"
#include "nadir/map_matching/rotated_template.hpp"

namespace nadir {

/// A rectangle of map pixels that the robot may stand on. It may reach beyond the map.
struct PixelWindow {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
};

/// Scores of one heading over a window: NaN where undefined.
struct ScoreSurface {
  Raster<float> score;
  Raster<float> valid_weight;
};

/// What a backend keeps of a map for all matches in it: spectra, copies on a device. It may grow
/// under its owner's lock, so that matches in one map can run on several threads.
class PreparedMap {
 public:
  virtual ~PreparedMap() = default;
};

/// What an implementation of map matching provides. Every backend is held to `reference`. Scoring
/// throws Stopped.
class MatchingBackend {
 public:
  virtual ~MatchingBackend() = default;
  /// Called once for a map, when its index is made; nothing where the backend keeps nothing.
  virtual std::shared_ptr<PreparedMap> prepare(const MapIndex&) const { return nullptr; }
  /// One surface per template, all over the same window.
  virtual std::vector<ScoreSurface> score_surfaces(const MapIndex& map,
                                                   std::span<const RotatedTemplate> templates,
                                                   const PixelWindow& window,
                                                   const StopToken& stop = {}) const = 0;
  virtual std::vector<PoseScore> score_poses(const MapIndex& map, const Template& local,
                                             std::span<const Pose2> map_from_robot,
                                             const StopToken& stop = {}) const = 0;
};

const MatchingBackend& reference_backend();
const MatchingBackend& cpu_backend();
/// Its calls throw Error (usage) where this build has no CUDA, (processing) where no GPU can be
/// used or the GPU fails: cuda_status() tells beforehand.
const MatchingBackend& cuda_backend();
const MatchingBackend& backend_of(const MatchingOptions& options);

}  // namespace nadir
