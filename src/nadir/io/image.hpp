// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>

#include "nadir/core/raster.hpp"

namespace nadir {

/// Reads PNG, JPEG, TIFF as 8-bit grey (1 channel) or RGB (3 channels, in that order). The pixels
/// come as they are stored, whatever the EXIF orientation says; alpha is dropped.
/// Throws Error (input) for a missing, empty, cut-off, non-image or Git LFS pointer file, and for
/// more than 8 bits a channel.
Raster<std::uint8_t> read_image(const std::filesystem::path& path);

/// Writes a PNG of 1 (grey), 3 (RGB) or 4 (RGBA) channels, atomically.
/// Throws Error (processing).
void write_png(const std::filesystem::path& path, const Raster<std::uint8_t>& image);

}  // namespace nadir
