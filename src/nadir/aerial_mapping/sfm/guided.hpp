// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/aerial_mapping/sfm/features.hpp"
#include "nadir/aerial_mapping/sfm/matching.hpp"
#include "nadir/aerial_mapping/sfm/model.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Matches again, with known poses: a feature of one photo is looked for only where the other photo
/// would see it, on its epipolar line and with the ground between `lowest` and `highest`. So few
/// rivals pass there that grass and asphalt give matches which a search of the whole photo must
/// doubt. Pairs are those of `pairs` whose photos are both known; the inliers are replaced where
/// more are found.
void rematch(const Model& model, const std::vector<PhotoFeatures>& features, double lowest,
             double highest, std::vector<VerifiedPair>& pairs, const StopToken& stop);

}  // namespace nadir::aerial
