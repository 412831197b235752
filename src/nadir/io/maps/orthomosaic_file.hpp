// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "nadir/core/orthomosaic.hpp"

namespace nadir {

/// What stands in the mask of an orthomosaic that was read, where it is no hole.
inline constexpr std::uint8_t kSeen = 255;

/// The scale of an image that carries no geo-reference.
struct PlainImageGeo {
  double metres_per_pixel = 0.1;  ///< above 0
};

/// Reads a GeoTIFF, COG, VRT, an image with a world file (and .prj), or, with `plain`, an image
/// without any geo-reference, whose frame has its origin at the outer lower-left corner, x right, y
/// up, metres. A geo-reference in the file goes before `plain`.
///
/// One colour band gives 1 channel, three give RGB. `valid` is 0 or 255: a hole is where alpha or
/// the mask band is 0, or where every colour is nodata. The reference system is WKT as GDAL writes
/// it; local metres give none.
///
/// Throws Error (input), with the command that cures it, for a file that is missing, cut off or no
/// image, pixels other than 8-bit grey or RGB (16-bit, palette, CMYK), a grid that is rotated, not
/// square, or not in true metres (geographic, Mercator), and a missing geo-reference without
/// `plain`.
Orthomosaic read_orthomosaic(const std::filesystem::path& path,
                             std::optional<PlainImageGeo> plain = std::nullopt);

/// Writes by extension: .tif (GeoTIFF: tiled, DEFLATE, internal mask, overviews when larger than
/// 1024 pixels) or .png (grey+alpha or RGBA, where alpha 0 is a hole, with its world file .pgw, and
/// .prj where there is a reference system). Atomic; the same orthomosaic gives the same bytes.
/// Throws Error (processing) where it cannot be written, (usage) for another extension.
void write_orthomosaic(const std::filesystem::path& path, const Orthomosaic& orthomosaic);

}  // namespace nadir
