// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace nadir {

/// So many bytes from a position on, of a file or of what was read of one; fewer at its end.
using BytesAt = std::function<std::string(std::uint64_t position, std::size_t count)>;

/// More than any camera gives.
inline constexpr std::uint64_t kMostBands = 1024;

/// What a directory of a TIFF says about its image. Of a tag that is there twice the value that
/// asks for more room: decoders differ in which they take.
struct TiffDirectory {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t bands = 1;
  std::uint64_t bits = 1;         ///< of a value
  std::uint64_t compression = 1;  ///< 1 = none
  bool bands_apart = false;       ///< each in blocks of its own
  std::uint64_t block_width = 0;  ///< of a tile, or of a strip, which is as wide as the image
  std::uint64_t block_height = 0;
};

/// The first directory of a TIFF or BigTIFF; nothing where there is none.
std::optional<TiffDirectory> first_tiff_directory(const BytesAt& bytes);

/// Looks at every directory of a TIFF or BigTIFF (maps, overviews, masks) before a decoder does,
/// which makes room for a block and for every band. Throws Error (input) where one declares
///   more than kMostBands bands;
///   blocks of more than 2^26 pixels that are larger than the image;
///   blocks of more than 64 MiB that the file cannot hold by its compression;
/// and where the directories overlap, as one file could name itself again and again.
/// Blocks that are not there, as in a sparse file, are sound, and so is a directory that cannot be
/// read: the decoder says so.
void check_tiff(const std::filesystem::path& path, const BytesAt& bytes, std::uint64_t file_size);

}  // namespace nadir
