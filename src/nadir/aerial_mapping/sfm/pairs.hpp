// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "nadir/aerial_mapping/photo_set.hpp"

namespace nadir::aerial {

using PhotoPairs = std::vector<std::pair<std::size_t, std::size_t>>;  ///< first < second, sorted

/// Which photos are compared: the nearest in position and the neighbours in time; all with all
/// where a photo has no position. `photos` are sorted by name.
PhotoPairs choose_pairs(const std::vector<MappingPhoto>& photos, int neighbours);

/// Groups of photos that `links` join, the largest first, then by the smallest index.
std::vector<std::vector<std::size_t>> components_of(std::size_t photos, const PhotoPairs& links);

}  // namespace nadir::aerial
