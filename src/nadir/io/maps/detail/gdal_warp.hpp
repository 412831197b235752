// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/maps/orthomosaic_import.hpp"

namespace nadir {

/// Brings an opened image onto a north-up grid of square pixels in true metres, in memory, and says
/// in `notes` what was done. Nothing where the grid is one already and has the wanted resolution.
/// Throws Error (input).
GdalDataset warped_to_metric(GDALDataset& dataset, const std::filesystem::path& path,
                             const ImportOptions& options, std::vector<std::string>& notes);

/// A palette as red, green, blue.
GdalDataset expanded_palette(GDALDataset& dataset, const std::filesystem::path& path);

/// Throws Error (input) where a map of so many pixels would be larger than the options allow, or
/// where its size is no number.
void check_result_size(double width, double height, const ImportOptions& options,
                       const std::filesystem::path& path);

}  // namespace nadir
