// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "nadir/core/orthomosaic.hpp"

namespace nadir {

struct PlainImageGeo {
  double metres_per_pixel = 0.1;  ///< for an image that carries no geo-reference
};

/// Reads a GeoTIFF, COG, VRT, an image with world file, or (with `plain`) a plain image whose frame
/// then has its origin at the outer lower-left corner, x right, y up, metres.
/// Validity comes from alpha, mask band or nodata. Throws Error (input) for what cannot be read,
/// a rotated or geographic grid, a size that differs, or a plain image without `plain`.
Orthomosaic read_orthomosaic(const std::filesystem::path& path,
                             std::optional<PlainImageGeo> plain = std::nullopt);

/// Writes by extension: .tif (GeoTIFF, tiled, DEFLATE, internal mask) or .png (grey+alpha or RGBA,
/// with its .pgw world file). Atomic.
void write_orthomosaic(const std::filesystem::path& path, const Orthomosaic& orthomosaic);

}  // namespace nadir
