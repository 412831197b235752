// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "nadir/io/photos/control_points.hpp"
#include "nadir/pipelines/flight/flight_input.hpp"

namespace nadir {

/// Adds ground control points to the set, their marks in pixels of the working size. Marks that lie
/// outside of a photo, but inside the full size that its EXIF states, are taken as pixels of that
/// size, and this is said. Throws Error (usage) for fewer than three points, points on a line,
/// points far from the photos (a wrong reference system), and marks outside of either size.
void add_control_points(const std::vector<ListedControlPoint>& points,
                        const std::filesystem::path& file, FlightInput& input);

}  // namespace nadir
