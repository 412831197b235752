// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/image_file_check.hpp"

#include <cstdint>

#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegSignature = "\xff\xd8\xff";

std::uint8_t byte_at(std::string_view bytes, std::size_t position) {
  return static_cast<std::uint8_t>(bytes[position]);
}

std::size_t big_endian(std::string_view bytes, std::size_t position, int count) {
  std::size_t value = 0;
  for (int i = 0; i < count; ++i) {
    value = value << 8 | byte_at(bytes, position + static_cast<std::size_t>(i));
  }
  return value;
}

/// Walks the chunks: length, type, data, checksum.
bool is_whole_png(std::string_view bytes) {
  constexpr std::size_t kOverhead = 12;
  std::size_t position = kPngSignature.size();
  while (position + kOverhead <= bytes.size()) {
    const std::size_t size = kOverhead + big_endian(bytes, position, 4);
    if (size > bytes.size() - position) return false;
    if (bytes.substr(position + 4, 4) == "IEND") return true;
    position += size;
  }
  return false;
}

/// The position of the next marker's code at or after `position`: a 0xff that is followed by
/// neither a stuffed zero nor another fill byte.
std::size_t next_marker(std::string_view bytes, std::size_t position) {
  while (true) {
    position = bytes.find('\xff', position);
    if (position == std::string_view::npos) return position;
    position = bytes.find_first_not_of('\xff', position);
    if (position == std::string_view::npos || bytes[position] != '\0') return position;
  }
}

/// Walks the segments and skips the coded data between them. A search for the end marker alone
/// would find the one of a thumbnail.
bool is_whole_jpeg(std::string_view bytes) {
  constexpr std::uint8_t kRestart0 = 0xd0;
  constexpr std::uint8_t kStart = 0xd8;
  constexpr std::uint8_t kEnd = 0xd9;
  std::size_t position = next_marker(bytes, 0);
  while (position != std::string_view::npos) {
    const std::uint8_t marker = byte_at(bytes, position);
    if (marker == kEnd) return true;
    std::size_t skipped = 1;
    if (marker < kRestart0 || marker > kStart) {
      if (position + 3 > bytes.size()) return false;
      skipped += big_endian(bytes, position + 1, 2);
    }
    position = next_marker(bytes, position + skipped);
  }
  return false;
}

}  // namespace

void check_image_is_whole(const std::filesystem::path& path, std::string_view bytes) {
  const bool cut_off = (bytes.starts_with(kPngSignature) && !is_whole_png(bytes)) ||
                       (bytes.starts_with(kJpegSignature) && !is_whole_jpeg(bytes));
  if (cut_off) {
    throw input_error(path, "the image is cut off: its end marker is missing",
                      "copy or download it again");
  }
}

}  // namespace nadir
