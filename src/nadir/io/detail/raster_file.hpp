// SPDX-License-Identifier: Apache-2.0
#pragma once

// The one place where GDAL opens a file that came from elsewhere.

#include <filesystem>
#include <optional>
#include <string_view>

#include "nadir/io/detail/gdal_support.hpp"

namespace nadir {

/// The formats that are given to GDAL. Every one of them has its header checked before: of GDAL's
/// two hundred drivers some make room for whatever a header declares, and some open addresses.
enum class RasterFormat { kTiff, kPng, kJpeg, kAsciiGrid, kVrt };

/// By the first bytes of a file: 1 KiB, or all.
std::optional<RasterFormat> raster_format(std::string_view head);

/// What a raster is opened as; kPhoto takes TIFF, PNG and JPEG.
enum class RasterUse { kMap, kPhoto };

/// Opens a local file with the one driver of its format. Throws Error (input) that names the cure:
///   for a file that is missing or of another format, and for GDAL's virtual file systems;
///   for a TIFF as check_tiff does, for a PNG or JPEG that declares more pixels than its bytes can
///   hold, for an ASCII grid that declares more values than it has bytes;
///   for a VRT that does more than put bands of local files of the other formats side by side;
///   for overviews in a file that the raster names, or that lie beside it and are no TIFF;
///   where GDAL cannot open it, and where it has no band.
GdalDataset open_raster(const std::filesystem::path& file, const GdalErrors& errors,
                        RasterUse use = RasterUse::kMap);

}  // namespace nadir
