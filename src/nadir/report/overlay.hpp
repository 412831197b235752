// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/report/colour_bar.hpp"
#include "nadir/report/map_view.hpp"

namespace nadir::report {

/// Range of the finite values; nothing where there is none.
std::optional<ColourScale> scale_of(const Raster<float>& values, const std::string& name);

/// Values as a picture: a pixel each, valid where the value is finite.
Orthomosaic coloured(const Raster<float>& values, const GeoReference& geo, const ColourScale& scale,
                     ColourMap map);

/// Lays such a picture over a map; low values leave more of the map to be seen.
void draw_overlay(Canvas& canvas, const MapView& view, const Orthomosaic& picture);

}  // namespace nadir::report
