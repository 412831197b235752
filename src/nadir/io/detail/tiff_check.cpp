// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/tiff_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string_view>

#include "nadir/io/input_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

constexpr std::uint64_t kMost = std::numeric_limits<std::uint64_t>::max();

/// The product, or the largest number where that has no room for it.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  return a == 0 || b <= kMost / a ? a * b : kMost;
}

/// Walks the directories of a file: TIFF 6.0, and the wider fields of a BigTIFF.
class TiffReader {
 public:
  explicit TiffReader(const BytesAt& bytes) : bytes_(bytes) {
    const std::string head = bytes_(0, 16);
    constexpr std::uint64_t kBig = 43;
    little_ = head.starts_with("II");
    big_ = number(head, 2, 2) == kBig;
    next_ = big_ ? number(head, 8, 8) : number(head, 4, 4);
  }

  /// The next directory; nothing behind the last one, at one that was there, and where none can be
  /// read.
  std::optional<TiffDirectory> next() {
    if (next_ == 0 || !seen_.insert(next_).second) return std::nullopt;
    const std::uint64_t count_size = big_ ? 8 : 2;
    const std::uint64_t entry_size = big_ ? 20 : 12;
    const std::string count_bytes = bytes_(next_, count_size);
    if (count_bytes.size() < count_size) return std::nullopt;
    // A BigTIFF may say more, which no decoder takes.
    const std::uint64_t count =
        std::min<std::uint64_t>(number(count_bytes, 0, count_size), 0xffffU);
    const std::string entries = bytes_(next_ + count_size, count * entry_size);
    bytes_of_directories_ += entries.size();
    directory_ = {};
    rows_ = 0;
    apart_ = together_ = false;
    for (std::uint64_t at = 0; at + entry_size <= entries.size(); at += entry_size) {
      take(std::string_view(entries).substr(at, entry_size));
    }
    const std::uint64_t pointer_size = big_ ? 8 : 4;
    const std::uint64_t end = next_ + count_size + count * entry_size;
    next_ = number(bytes_(end, pointer_size), 0, pointer_size);
    return finished();
  }

  /// Of all directories so far. In a sound file they do not overlap, so that it is no more than the
  /// file has.
  std::uint64_t bytes_of_directories() const { return bytes_of_directories_; }

 private:
  /// An unsigned number in the order of the file; 0 beyond the end.
  std::uint64_t number(std::string_view bytes, std::uint64_t position, std::uint64_t size) const {
    if (size > bytes.size() || position > bytes.size() - size) return 0;
    std::uint64_t value = 0;
    for (std::uint64_t i = 0; i < size; ++i) {
      const char byte = bytes[position + (little_ ? size - 1 - i : i)];
      value = value << 8U | static_cast<std::uint8_t>(byte);
    }
    return value;
  }

  static std::uint64_t size_of(std::uint64_t type) {
    switch (type) {
      case 1:  // bytes and texts
      case 2:
      case 6:
      case 7:
        return 1;
      case 3:  // 16 bits
      case 8:
        return 2;
      case 16:  // 64 bits
      case 17:
      case 18:
        return 8;
      default:
        return 4;
    }
  }

  /// The first value of an entry, which lies elsewhere where all of them do not fit in it.
  std::uint64_t value_of(std::string_view entry) {
    const std::uint64_t size = size_of(number(entry, 2, 2));
    const std::uint64_t count = number(entry, 4, big_ ? 8 : 4);
    const std::uint64_t place = big_ ? 12 : 8;
    const std::uint64_t room = big_ ? 8 : 4;
    if (product(size, count) <= room) return number(entry, place, size);
    return number(bytes_(number(entry, place, room), size), 0, size);
  }

  void take(std::string_view entry) {
    const auto raise = [&](std::uint64_t& field) { field = std::max(field, value_of(entry)); };
    switch (number(entry, 0, 2)) {
      case 256:
        return raise(directory_.width);
      case 257:
        return raise(directory_.height);
      case 258:
        return raise(directory_.bits);
      case 259:
        return raise(directory_.compression);
      case 277:
        return raise(directory_.bands);
      case 278:
        return raise(rows_);
      case 284:
        (value_of(entry) == 2 ? apart_ : together_) = true;
        return;
      case 322:
        return raise(directory_.block_width);
      case 323:
        return raise(directory_.block_height);
      default:
        return;
    }
  }

  TiffDirectory finished() const {
    TiffDirectory result = directory_;
    result.bands_apart = apart_ && !together_;
    if (result.block_width == 0 && result.block_height == 0) {
      result.block_width = result.width;
      result.block_height = rows_ == 0 ? result.height : std::min(rows_, result.height);
    }
    return result;
  }

  const BytesAt& bytes_;
  bool little_ = true;
  bool big_ = false;
  std::uint64_t next_ = 0;
  std::set<std::uint64_t> seen_;
  std::uint64_t bytes_of_directories_ = 0;
  TiffDirectory directory_;
  std::uint64_t rows_ = 0;  ///< of a strip; 0 = all
  bool apart_ = false;
  bool together_ = false;
};

/// How many bytes come out of one at most.
std::uint64_t most_out_of_a_byte(std::uint64_t compression) {
  switch (compression) {
    case 1:  // none
      return 1;
    case 32773:  // PackBits: 128 out of two
      return 64;
    case 5:  // LZW: a code of 12 bits stands for a run that is as long as the table is large
      return 4096;
    case 8:  // DEFLATE
    case 32946:
      return 1032;
    case 6:  // JPEG: blocks of 8 x 8 pixels
    case 7:
      return 1024;
    default:  // fax, LERC, Zstandard and others code a constant image in next to nothing
      return 65'536;
  }
}

void check_directory(const std::filesystem::path& path, const TiffDirectory& directory,
                     std::uint64_t file_size) {
  if (directory.bands > kMostBands) {
    throw input_error(path,
                      fmt::format("its header declares {} bands, more than the {} that are read",
                                  directory.bands, kMostBands),
                      fmt::format("pick the colours: gdal_translate -b 1 -b 2 -b 3 {} out.tif",
                                  shell_quoted_path(path)));
  }
  constexpr std::uint64_t kLargeBlock = std::uint64_t{1} << 26U;  // pixels, and bytes
  const std::uint64_t pixels = product(directory.block_width, directory.block_height);
  const std::string blocks = fmt::format("its header declares blocks of {} x {} pixels",
                                         directory.block_width, directory.block_height);
  if (pixels > kLargeBlock && pixels > product(directory.width, directory.height)) {
    throw input_error(path, blocks, "the header is damaged: copy or make it again");
  }
  const std::uint64_t bands = directory.bands_apart ? 1 : directory.bands;
  const std::uint64_t size = product(product(pixels, bands), directory.bits) / 8;
  if (size > kLargeBlock && size / most_out_of_a_byte(directory.compression) > file_size) {
    throw input_error(
        path, fmt::format("{} and {} bands, which {} bytes cannot hold", blocks, bands, file_size),
        "copy or download it again, it is cut off or damaged");
  }
}

}  // namespace

std::optional<TiffDirectory> first_tiff_directory(const BytesAt& bytes) {
  return TiffReader(bytes).next();
}

void check_tiff(const std::filesystem::path& path, const BytesAt& bytes, std::uint64_t file_size) {
  TiffReader reader(bytes);
  while (const auto directory = reader.next()) {
    if (reader.bytes_of_directories() > file_size) {
      throw input_error(path, "its directories overlap", "copy or make it again, it is damaged");
    }
    check_directory(path, *directory, file_size);
  }
}

}  // namespace nadir
