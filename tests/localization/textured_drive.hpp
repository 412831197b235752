// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "map_matching/random_maps.hpp"

namespace nadir::test {

// A drive over a texture that is known exactly at every point.
inline constexpr int kFrames = 12;
inline const Texture kTexture(31);
inline const GeoReference kMapGeo{0.0, 20.0, 0.1, {}};

inline Orthomosaic map_image() { return render(kTexture, 300, 200, kMapGeo, Pose2{}); }

inline Pose2 truth_at(int frame) {
  return {8.0 + 0.6 * frame, 9.0 + 0.15 * frame, 0.25 + 0.02 * frame};
}

}  // namespace nadir::test
