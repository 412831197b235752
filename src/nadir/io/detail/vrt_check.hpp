// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

namespace nadir {

/// The files that a VRT names, each once. A VRT may open files by any driver of GDAL, addresses,
/// files of raw bytes and programs; what gdalbuildvrt and gdal_translate write needs none of that.
/// Throws Error (input) that names what is not read and how to write the mosaic as a GeoTIFF:
///   for every element but those that describe a raster and put bands of files side by side;
///   for a band or a mosaic of a class of its own (warped, raw, derived);
///   for a source that is no local file by its plain name, or not there.
std::vector<std::filesystem::path> vrt_sources(const std::filesystem::path& path);

}  // namespace nadir
