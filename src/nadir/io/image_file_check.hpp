// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

namespace nadir {

/// 2^30, where OpenCV ends too: a gigapixel, 3 GB of RGB.
inline constexpr std::uint64_t kMostImagePixels = std::uint64_t{1} << 30U;

/// Throws Error (input) where a JPEG or PNG ends before its end marker: decoders fill the missing
/// part with grey and say nothing. Other formats pass: their decoders do notice.
void check_image_is_whole(const std::filesystem::path& path, std::string_view bytes);

/// Checks the size that the header of a PNG, JPEG, TIFF or PNM file declares before a decoder makes
/// room for it: at most kMostImagePixels, and no more than the bytes can hold by the compression of
/// the format. Throws Error (input) where it lies, and for every other format.
void check_image_size(const std::filesystem::path& path, std::string_view bytes);

}  // namespace nadir
