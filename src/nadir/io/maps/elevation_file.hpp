// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "nadir/core/elevation_map.hpp"

namespace nadir {

/// Reads heights in metres: the single band of a GeoTIFF, COG, Arc/Info ASCII grid, PNG or VRT, of
/// any number type; nodata, masked and non-finite values become NaN. Throws Error (input) for a
/// file that is missing, cut off or of another format, several bands, a grid that is rotated, not
/// square or not in true metres, no geo-reference, and no height at all.
ElevationMap read_elevation_map(const std::filesystem::path& path);

/// Whether a raster is one band of floating-point numbers, as heights are and pictures are not, or
/// an ASCII grid (.asc).
/// False for what cannot be opened.
bool looks_like_heights(const std::filesystem::path& path);

/// Writes a GeoTIFF: 32-bit floats, nodata -9999, tiled, DEFLATE, overviews when larger than 1024
/// pixels. Atomic; the same heights give the same bytes. Throws Error (processing) where it cannot
/// be written, (usage) for another extension than .tif.
void write_elevation_map(const std::filesystem::path& path, const ElevationMap& elevation);

}  // namespace nadir
