// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace nadir::fuzz {

/// Whether GDAL takes the file for a raster of at most four million values. A header may declare
/// far more, up to the limits of the readers, and the time that such a raster takes is no finding.
bool is_small_raster(const std::filesystem::path& file);

}  // namespace nadir::fuzz
