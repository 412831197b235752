// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/image_file_check.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string>

#include "nadir/io/detail/tiff_check.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";
constexpr std::string_view kJpegSignature = "\xff\xd8\xff";
constexpr std::string_view kSpace = " \t\r\n";

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

BytesAt bytes_of(std::string_view bytes) {
  return [bytes](std::uint64_t position, std::size_t count) {
    return position < bytes.size()
               ? std::string(bytes.substr(static_cast<std::size_t>(position), count))
               : std::string();
  };
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

/// What a header says, and how many pixels a byte of this format can hold at most.
struct DeclaredSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
  std::uint64_t pixels_of_byte = 0;
};

/// IHDR is the first chunk. DEFLATE packs a byte of zeros, eight pixels of one bit, 1032 times.
std::optional<DeclaredSize> png_size(std::string_view bytes) {
  constexpr std::size_t kWidth = 16;
  if (bytes.size() < kWidth + 8) return std::nullopt;
  return DeclaredSize{big_endian(bytes, kWidth, 4), big_endian(bytes, kWidth + 4, 4),
                      std::uint64_t{8} * 1032};
}

/// Of the first start-of-frame segment. A block of 8 x 8 pixels takes a bit and more.
std::optional<DeclaredSize> jpeg_size(std::string_view bytes) {
  std::size_t position = next_marker(bytes, 0);
  while (position != std::string_view::npos && position + 8 <= bytes.size()) {
    const std::uint8_t marker = byte_at(bytes, position);
    const bool frame =
        marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
    if (frame) {
      return DeclaredSize{big_endian(bytes, position + 6, 2), big_endian(bytes, position + 4, 2),
                          std::uint64_t{8} * 64};
    }
    const bool bare = marker >= 0xd0 && marker <= 0xd8;
    position = next_marker(bytes, position + 1 + (bare ? 0 : big_endian(bytes, position + 1, 2)));
  }
  return std::nullopt;
}

/// Of the first directory. Fax compression codes a white line of a page in some bits.
std::optional<DeclaredSize> tiff_size(std::string_view bytes) {
  const auto directory = first_tiff_directory(bytes_of(bytes));
  if (!directory) return std::nullopt;
  return DeclaredSize{directory->width, directory->height, 65'536};
}

/// P1 to P6: two numbers behind white space and comments. A bit a pixel is the least.
std::optional<DeclaredSize> pnm_size(std::string_view bytes) {
  DeclaredSize size{0, 0, 8};
  std::size_t position = 2;
  for (std::uint64_t* side : {&size.width, &size.height}) {
    while (position < bytes.size()) {
      position = std::min(bytes.find_first_not_of(kSpace, position), bytes.size());
      if (position >= bytes.size() || bytes[position] != '#') break;
      position = std::min(bytes.find('\n', position), bytes.size());
    }
    const char* begin = bytes.data() + position;
    const auto [end, error] = std::from_chars(begin, bytes.data() + bytes.size(), *side);
    position += static_cast<std::size_t>(end - begin);
    // Decoders differ in what else may end a number.
    const bool ended =
        position < bytes.size() && kSpace.find(bytes[position]) != std::string_view::npos;
    if (error != std::errc{} || !ended) return std::nullopt;
  }
  return size;
}

std::optional<DeclaredSize> declared_size(ImageFormat format, std::string_view bytes) {
  switch (format) {
    case ImageFormat::kPng:
      return png_size(bytes);
    case ImageFormat::kJpeg:
      return jpeg_size(bytes);
    case ImageFormat::kTiff:
      return tiff_size(bytes);
    case ImageFormat::kPnm:
      return pnm_size(bytes);
  }
  return std::nullopt;
}

}  // namespace

std::optional<ImageFormat> image_format(std::string_view bytes) {
  using namespace std::string_view_literals;
  if (bytes.starts_with(kPngSignature)) return ImageFormat::kPng;
  if (bytes.starts_with(kJpegSignature)) return ImageFormat::kJpeg;
  for (const auto signature : {"II*\0"sv, "MM\0*"sv, "II+\0"sv, "MM\0+"sv}) {
    if (bytes.starts_with(signature)) return ImageFormat::kTiff;
  }
  const bool pnm = bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
                   kSpace.find(bytes[2]) != std::string_view::npos;
  return pnm ? std::optional(ImageFormat::kPnm) : std::nullopt;
}

void check_image_size(const std::filesystem::path& path, std::string_view head,
                      std::uint64_t file_size, std::uint64_t most_pixels) {
  constexpr std::uint64_t kSmall = std::uint64_t{1} << 20U;  // pixels: not worth an argument
  const auto format = image_format(head);
  const auto size = format ? declared_size(*format, head) : std::nullopt;
  if (!size || size->width == 0 || size->height == 0) {
    throw input_error(path, "is not an image that can be decoded",
                      "give a PNG, JPEG, TIFF or PNM file, or copy it again if it is damaged");
  }
  const std::string sides =
      std::to_string(size->width) + " x " + std::to_string(size->height) + " pixels";
  if (size->width > most_pixels / size->height) {
    throw input_error(path, "its header declares " + sides + ", which is too large",
                      "cut it into parts, or copy it again if it is damaged");
  }
  const std::uint64_t pixels = size->width * size->height;
  if (pixels > kSmall && pixels / size->pixels_of_byte > file_size) {
    throw input_error(path,
                      "its header declares " + sides + ", which " + std::to_string(file_size) +
                          " bytes cannot hold",
                      "copy or download it again");
  }
}

void check_image_size(const std::filesystem::path& path, std::string_view bytes) {
  check_image_size(path, bytes, bytes.size(), kMostImagePixels);
  if (image_format(bytes) == ImageFormat::kTiff) check_tiff(path, bytes_of(bytes), bytes.size());
}

void check_image_is_whole(const std::filesystem::path& path, std::string_view bytes) {
  const bool cut_off = (bytes.starts_with(kPngSignature) && !is_whole_png(bytes)) ||
                       (bytes.starts_with(kJpegSignature) && !is_whole_jpeg(bytes));
  if (cut_off) {
    throw input_error(path, "the image is cut off: its end marker is missing",
                      "copy or download it again");
  }
}

}  // namespace nadir
