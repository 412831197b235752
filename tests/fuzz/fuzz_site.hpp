// SPDX-License-Identifier: Apache-2.0
#pragma once

// Small images that the texts of a site or a drive speak of.

#include "fuzz/fuzz_target.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/raster.hpp"

namespace nadir::fuzz {

/// Blocks of grey levels, half a metre a pixel, so that places can be told apart.
Orthomosaic small_map(int width, int height, Point2<frames::Map> north_west);

/// Writes a PNG of 8 x 6 pixels below the scratch folder where it is not there yet.
void small_image(const std::string& name);

/// Writes a site's images where they are not there yet: map.tif, local/1.tif, local/2.tif.
void small_site(const std::string& folder);

}  // namespace nadir::fuzz
