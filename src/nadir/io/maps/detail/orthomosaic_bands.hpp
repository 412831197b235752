// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/raster.hpp"
#include "nadir/io/detail/gdal_support.hpp"

// What reading and importing an orthomosaic share.
namespace nadir {

/// Throws Error (input) for a PNG or JPEG that is cut off.
void check_orthomosaic_file(const std::filesystem::path& path);

/// "convert it: gdal_translate ARGUMENTS PATH out.tif".
std::string translate_line(const std::filesystem::path& path, const std::string& arguments);

/// The bands that hold grey, or red, green and blue in this order. Throws Error (input) for CMYK
/// and other numbers of bands.
std::vector<int> colour_bands(GDALDataset& dataset, const std::filesystem::path& path);

/// Reads a whole band into one channel. Throws Error (input).
void read_band(GDALRasterBand& band, Raster<std::uint8_t>& into, int channel,
               const std::filesystem::path& path, const GdalErrors& errors);

/// Where GDAL's masks of the colour bands see anything: alpha and mask bands are shared by all of
/// them, and a pixel is nodata only where every colour is.
Raster<std::uint8_t> read_validity(GDALDataset& dataset, std::span<const int> bands,
                                   const std::filesystem::path& path, const GdalErrors& errors);

}  // namespace nadir
