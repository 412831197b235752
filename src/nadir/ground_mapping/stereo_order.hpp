// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/core/sensors.hpp"
#include "nadir/ground_mapping/options.hpp"

namespace nadir {

/// How well the two images match as left and right, and exchanged.
struct StereoOrder {
  double as_given = 0.0;  ///< share of the pixels with a disparity that both directions agree on
  double swapped = 0.0;
  /// The exchanged order matches much better: left and right are swapped.
  bool looks_swapped() const { return swapped > 0.2 && as_given < 0.5 * swapped; }
};

/// Matches the pair in both orders, at half size. GroundMapper asks this of its first frame.
StereoOrder stereo_order(const StereoRig& rig, const StereoFrame& frame,
                         const GroundMappingOptions& options);

}  // namespace nadir
