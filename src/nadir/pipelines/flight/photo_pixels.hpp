// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "nadir/core/raster.hpp"

namespace nadir {

/// Gives the pixels of photos at their working size. Decoded photos are kept in memory as long as
/// all of them take less than `budget_bytes`; the rest is decoded anew each time.
class PhotoPixels {
 public:
  explicit PhotoPixels(int max_image_px, std::size_t budget_bytes = 512U << 20U);

  /// May outlive this object; may be called from several threads.
  std::function<Raster<std::uint8_t>()> loader(const std::filesystem::path& file) const;

 private:
  struct Store;
  std::shared_ptr<Store> store_;
};

}  // namespace nadir
