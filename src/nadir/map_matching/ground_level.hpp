// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "nadir/map_matching/resample.hpp"

namespace nadir {

/// The level of the ground below every valid pixel of `heights` (metres): a plane fitted to the
/// surroundings, weighted by a Gaussian of `sigma_px` pixels over what is known (normalised
/// convolution with a linear basis, Knutsson and Westin, 1993) and refitted without what stands
/// above it (iteratively reweighted least squares with Cauchy's weight on the upper side). A slope
/// is followed up to holes and borders; walls, hedges and cars are not. 0 where `heights` is
/// invalid.
Raster<float> ground_level(const GreyImage& heights, double sigma_px);

}  // namespace nadir
