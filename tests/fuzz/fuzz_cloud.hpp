// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

#include "fuzz/fuzz_target.hpp"
#include "nadir/io/drives/point_cloud.hpp"

namespace nadir::fuzz {

/// A cloud holds no more points than its bytes can, and each is finite.
inline void require_cloud(const PointCloud& cloud, std::size_t bytes) {
  require(cloud.points.size() + cloud.invalid <= bytes, "more points than bytes");
  require(!cloud.points.empty(), "a cloud without points");
  for (const LidarPoint& point : cloud.points) {
    require(std::isfinite(point.x) && std::isfinite(point.y) && std::isfinite(point.z),
            "a point is not finite");
  }
}

}  // namespace nadir::fuzz
