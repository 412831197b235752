// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "nadir/core/error.hpp"
#include "nadir/core/geo_reference.hpp"
#include "nadir/io/detail/gdal_support.hpp"

namespace nadir {

/// The shape of a GeoTIFF that is to be written.
struct GeoTiffShape {
  int width = 0;
  int height = 0;
  int bands = 1;
  GDALDataType type = GDT_Byte;
};

/// Creates a GeoTIFF (tiled 512, DEFLATE with the predictor of its type, BigTIFF where needed) with
/// its geo-reference. `path` is the name that errors speak of, `temporary` the file. Throws Error
/// (processing).
GdalDataset create_geotiff(const std::string& temporary, const GeoTiffShape& shape,
                           const GeoReference& geo, const std::filesystem::path& path,
                           const GdalErrors& errors);

/// Overviews, each half the one before, of what is larger than 1024 pixels; false where they cannot
/// be written.
bool build_overviews(GDALDataset& dataset);

/// The error of a file that cannot be written.
Error write_error(const std::filesystem::path& path, const std::string& problem);

}  // namespace nadir
