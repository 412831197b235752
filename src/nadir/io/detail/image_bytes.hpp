// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "nadir/core/raster.hpp"

namespace nadir {

/// As read_image, of the bytes of a file that are in memory; `name` is what errors call it.
Raster<std::uint8_t> decode_image(const std::filesystem::path& path, std::string bytes);

}  // namespace nadir
