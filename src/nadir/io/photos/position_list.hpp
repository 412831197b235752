// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/photo.hpp"

namespace nadir {

/// What a list says of one photo; it goes before the photo's own tags.
struct ListedPosition {
  std::string photo;  ///< file name
  GeodeticPosition position;
  std::optional<GimbalAttitude> attitude;
};

/// Reads positions of photos, in one of two formats:
///   CSV `name,lat,lon,alt[,yaw,pitch,roll,sigma]`, degrees (yaw clockwise from north, pitch -90 =
///   down) and metres; a first line of column names may give another order; commas, semicolons or
///   tabs; an empty field is absent.
///   ODM's geo.txt: the reference system in the first line (EPSG:..., PROJ, "WGS84 UTM 32N"), then
///   `photo east north [height [omega phi kappa [sigma_xy sigma_z]]]`; the angles are not used.
/// Throws Error (input) with file:line for anything else, for impossible values and for a photo
/// that is listed twice.
std::vector<ListedPosition> read_positions(const std::filesystem::path& path);

}  // namespace nadir
