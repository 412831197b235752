// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>

#include "nadir/core/geo_reference.hpp"
#include "nadir/io/detail/gdal_support.hpp"

namespace nadir {

/// The geo-reference of an opened image; nothing where it carries none. Throws Error (input), with
/// the gdalwarp line that cures it, for a grid that is rotated, not square, not in metres or
/// stretched (geographic, Mercator).
std::optional<GeoReference> read_geo_reference(GDALDataset& dataset,
                                               const std::filesystem::path& path);

}  // namespace nadir
