// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace nadir::test {

/// An entry of a directory; its value, or where it lies.
struct TiffTag {
  std::uint16_t tag = 0;
  std::uint16_t type = 3;  ///< 3 = 16 bits, 4 = 32 bits, 12 = double
  std::uint32_t count = 1;
  std::uint32_t value = 0;
};

namespace tiff_tags {
inline constexpr std::uint16_t kWidth = 256;
inline constexpr std::uint16_t kHeight = 257;
inline constexpr std::uint16_t kBits = 258;
inline constexpr std::uint16_t kCompression = 259;
inline constexpr std::uint16_t kPhotometric = 262;
inline constexpr std::uint16_t kSamples = 277;
inline constexpr std::uint16_t kRowsPerStrip = 278;
inline constexpr std::uint16_t kPlanar = 284;
inline constexpr std::uint16_t kTileWidth = 322;
inline constexpr std::uint16_t kTileHeight = 323;
}  // namespace tiff_tags

inline std::string little_endian(std::uint64_t value, int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes += static_cast<char>(value >> (8 * i) & 0xffU);
  return bytes;
}

/// The head of a TIFF by hand, with what no writer would declare; one directory and no pixels.
inline std::string tiff_bytes(const std::vector<TiffTag>& tags, bool big = false) {
  std::string bytes = big ? "II\x2b" + std::string("\0\x08\0\0\0", 5) + little_endian(16, 8)
                          : "II\x2a" + std::string(1, '\0') + little_endian(8, 4);
  bytes += little_endian(tags.size(), big ? 8 : 2);
  for (const TiffTag& tag : tags) {
    bytes += little_endian(tag.tag, 2) + little_endian(tag.type, 2) +
             little_endian(tag.count, big ? 8 : 4) + little_endian(tag.value, big ? 8 : 4);
  }
  return bytes + little_endian(0, big ? 8 : 4);
}

}  // namespace nadir::test
