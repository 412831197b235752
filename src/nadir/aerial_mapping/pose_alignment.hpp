// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "nadir/aerial_mapping/photo_set.hpp"

namespace nadir {

/// Moves poses of a model of its own frame and scale into the map frame by the similarity that
/// fits their centres to the given positions best (Umeyama 1991, reflections excluded). Returns the
/// root mean square of the residuals, metres. `photos` gives the positions by name. Throws Error
/// (usage) for fewer than three photos with a position, and where these lie on a line, about which
/// the model could turn freely.
double align_poses(std::vector<PhotoPose>& poses, std::span<const MappingPhoto> photos);

}  // namespace nadir
