// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

namespace nadir {

/// EPSG code of the WGS84 grid of the UTM zone that holds a place, degrees: 326NN north of the
/// equator, 327NN south of it. The exceptions of Norway and Svalbard are left out. Nothing for what
/// is no place: PROJ hands on numbers that are not finite.
inline std::optional<int> utm_epsg(double latitude_deg, double longitude_deg) {
  if (!(std::abs(latitude_deg) <= 90.0) || !(std::abs(longitude_deg) <= 360.0)) return std::nullopt;
  const int zone =
      std::clamp(static_cast<int>(std::floor((longitude_deg + 180.0) / 6.0)) + 1, 1, 60);
  return (latitude_deg < 0.0 ? 32700 : 32600) + zone;
}

}  // namespace nadir
