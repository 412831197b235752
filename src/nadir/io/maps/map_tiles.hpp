// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/geo_reference.hpp"

namespace nadir {

/// An image as a file holds it.
struct EncodedImage {
  std::string media_type;  ///< "image/jpeg", "image/png"
  std::string bytes;
};

/// An orthomosaic cut into square tiles on demand, for looking at: read from its overviews and
/// never as a whole, so that the size of the map costs no memory. Level 0 is the coarsest and has
/// one tile; each next level doubles the resolution, and the last has the pixels of the file. May
/// be asked from several threads.
class MapTiles {
 public:
  static constexpr int kTileSize = 512;

  /// Opens a map of 8-bit grey or RGB with a geo-reference, of the formats of read_orthomosaic().
  /// Throws Error (input).
  explicit MapTiles(const std::filesystem::path& path);
  ~MapTiles();
  MapTiles(const MapTiles&) = delete;
  MapTiles& operator=(const MapTiles&) = delete;
  MapTiles(MapTiles&&) = delete;
  MapTiles& operator=(MapTiles&&) = delete;

  int width() const { return width_; }
  int height() const { return height_; }
  int levels() const { return levels_; }
  const GeoReference& geo() const { return geo_; }

  /// The tile `column` to the right of and `row` below the north-west corner: JPEG where all of it
  /// was seen, else PNG with alpha. Nothing where no such tile is. Throws Error (input) where the
  /// file cannot be read any more.
  std::optional<EncodedImage> tile(int level, int column, int row);

 private:
  struct Source;

  std::unique_ptr<Source> source_;
  int width_ = 0;
  int height_ = 0;
  int levels_ = 1;
  GeoReference geo_;
};

}  // namespace nadir
