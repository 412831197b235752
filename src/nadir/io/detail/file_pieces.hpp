// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

namespace nadir {

/// A file by pieces, so that a large one is never read whole. One thread at a time.
class FilePieces {
 public:
  explicit FilePieces(const std::filesystem::path& file)
      : stream_(file, std::ios::binary), size_(std::filesystem::file_size(file)) {}

  /// When it was opened, bytes.
  std::uint64_t size() const { return size_; }

  /// `count` bytes from a position on, fewer at the end of the file.
  std::string at(std::uint64_t position, std::size_t count) {
    if (position >= size_) return {};
    std::string bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, size_ - position)),
                      '\0');
    stream_.clear();
    stream_.seekg(static_cast<std::streamoff>(position));
    stream_.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(stream_.gcount()));
    return bytes;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
};

}  // namespace nadir
