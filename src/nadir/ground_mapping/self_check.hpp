// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/mapper.hpp"

namespace nadir {

/// How two local maps of one place agree.
struct MapComparison {
  int shift_columns = 0;      ///< of the best correlation: what the second seems displaced by
  int shift_rows = 0;         ///< 0, 0 where the maps agree
  double zncc = 0.0;          ///< at that shift, over pixels measured in both; NaN without overlap
  double zncc_unshifted = 0;  ///< where the poses say that they agree
  double height_median_m = 0.0;  ///< |difference| of the heights, unshifted; NaN without overlap
  double height_p90_m = 0.0;
  double overlap = 0.0;  ///< share of the pixels measured in both
};

/// Compares two maps rendered at one pose, size and resolution, at integer shifts of at most
/// `max_shift_px`. Throws Error (usage) where they differ in size.
MapComparison compare_local_maps(const LocalMap& a, const LocalMap& b, int max_shift_px = 10);

/// What to say where the comparison tells that the poses do not fit the images; nothing where they
/// fit. A wrong pose file raises the height disagreement two- to sevenfold and displaces the best
/// correlation, while the correlation itself falls by a tenth only.
std::optional<std::string> pose_misfit(const MapComparison& comparison);

/// Maps every other frame into one of two maps, so that the sensor checks itself.
class OddEvenCheck {
 public:
  template <class Rig>
  OddEvenCheck(const Rig& rig, const GroundMappingOptions& options)
      : even_(rig, unchecked(options)), odd_(rig, unchecked(options)) {}

  template <class SensorFrame>
  FrameStatistics integrate(const SensorFrame& frame, const OdomPose3& odom_from_robot) {
    last_ = odom_from_robot;
    return (count_++ % 2 == 0 ? even_ : odd_).integrate(frame, odom_from_robot);
  }

  /// Both maps seen from the last pose. Throws Error (usage) before the second frame.
  MapComparison compare(RenderOptions options) const;

  const GroundMapper& even() const { return even_; }
  const GroundMapper& odd() const { return odd_; }

 private:
  /// Poses that do not fit are to show in the maps here.
  static GroundMappingOptions unchecked(GroundMappingOptions options) {
    options.check_poses = false;
    return options;
  }

  GroundMapper even_;
  GroundMapper odd_;
  int count_ = 0;
  OdomPose3 last_;
};

}  // namespace nadir
