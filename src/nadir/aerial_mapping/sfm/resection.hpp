// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "nadir/aerial_mapping/sfm/model.hpp"

namespace nadir::aerial {

/// Finds the pose of a photo from the valid landmarks that its tracks meet (perspective n points,
/// RANSAC). False, and the photo left as it is, with fewer than `fewest` that agree.
bool resect(Model& model, std::size_t photo, int fewest, double threshold_px, std::uint64_t seed);

}  // namespace nadir::aerial
