// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace nadir::fuzz {

/// Whether the file is a raster of at most four million values, or none: opened as the readers do.
/// A header may declare far more, up to the limits of the readers, and the time that such a raster
/// takes is no finding.
bool is_small_raster(const std::filesystem::path& file);

}  // namespace nadir::fuzz
