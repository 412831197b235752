// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nadir/core/photo.hpp"

namespace nadir {

/// A ground control point and where it was marked in the photos.
struct ListedControlPoint {
  struct Mark {
    std::string photo;  ///< file name
    double u = 0.0;     ///< pixel of the photo, (0, 0) = centre of the first one
    double v = 0.0;
    std::string where;  ///< file:line
  };
  std::string name;
  GeodeticPosition position;
  std::vector<Mark> marks;
};

/// Reads ODM's gcp_list.txt: the reference system in the first line, then a line for each mark,
/// `east north height column row photo [name]`. Marks of one place are one point; without a name it
/// is called gcp1, gcp2 and so on. Throws Error (input) with file:line for a line of another kind,
/// a reference system that is not understood, coordinates outside of it, and a name that stands for
/// two places.
std::vector<ListedControlPoint> read_control_points(const std::filesystem::path& path);

}  // namespace nadir
