// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "nadir/aerial_mapping/aerial_map.hpp"

namespace nadir {

/// A picture inside a page.
struct Picture {
  std::string uri;  ///< data: with the PNG or JPEG in base 64
  int width = 0;
  int height = 0;
};

Picture colour_picture(const AerialMap& map);
Picture seam_picture(const AerialMap& map);
Picture view_picture(const AerialMap& map);
Picture surface_picture(const AerialMap& map);

}  // namespace nadir
