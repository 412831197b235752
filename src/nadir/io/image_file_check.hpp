// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace nadir {

/// 2^30, where OpenCV ends too: a gigapixel, 3 GB of RGB.
inline constexpr std::uint64_t kMostImagePixels = std::uint64_t{1} << 30U;

/// What OpenCV is given to decode; each has its header checked before.
enum class ImageFormat { kPng, kJpeg, kTiff, kPnm };

/// By the first bytes, all that the format prescribes: then OpenCV takes its decoder for it and
/// none of the others, some of which look for their mark elsewhere in a file.
std::optional<ImageFormat> image_format(std::string_view bytes);

/// Throws Error (input) where a JPEG or PNG ends before its end marker: decoders fill the missing
/// part with grey and say nothing. Other formats pass: their decoders do notice.
void check_image_is_whole(const std::filesystem::path& path, std::string_view bytes);

/// Checks the size that the header of a PNG, JPEG, TIFF or PNM file declares before a decoder makes
/// room for it: at most kMostImagePixels, and no more than the bytes can hold by the compression of
/// the format; and the blocks of a TIFF. Throws Error (input) where it lies, and for every other
/// format.
void check_image_size(const std::filesystem::path& path, std::string_view bytes);

/// The size alone, where the head of a file is known and how long the file is.
void check_image_size(const std::filesystem::path& path, std::string_view head,
                      std::uint64_t file_size, std::uint64_t most_pixels);

}  // namespace nadir
