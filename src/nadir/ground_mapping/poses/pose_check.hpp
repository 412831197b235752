// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/depth/sighting.hpp"
#include "nadir/ground_mapping/pose_fit.hpp"

namespace nadir::ground {

/// Judges pairs of frames of a drive: at its begin one after the other, later ones farther and
/// farther apart, so that all of a long drive is looked at for little time.
class PoseCheck {
 public:
  /// Notes the pose of the next frame; true where a sighting of that frame is wanted.
  bool step(const StampedOdomPose3& now);
  /// The sighting of that frame.
  void take(Sighting sighting);

  PoseFit fit() const;

 private:
  struct Seen {
    Sighting sighting;
    OdomPose3 odom_from_robot;
  };
  struct Pair {
    double offset_px = 0.0;
    double found_px = 0.0;  ///< how far the points move in the image
    double posed_px = 0.0;  ///< how far they should by the poses
    PoseFault fault = PoseFault::kUnknown;
  };

  /// Nothing where too little was found.
  static std::optional<Pair> judge(const Seen& first, const Seen& second);
  void close(Seen now);

  std::optional<StampedOdomPose3> last_;
  std::optional<Seen> first_;  ///< of the pair that is open
  std::optional<Pair> open_;   ///< what is known of it so far
  int frames_since_ = 0;       ///< since `first_`, or since the last pair was closed
  int closed_ = 0;
  std::vector<Pair> judged_;
  std::vector<double> steps_m_;
  std::vector<double> speeds_m_per_s_;
};

}  // namespace nadir::ground
