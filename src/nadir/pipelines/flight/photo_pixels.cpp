// SPDX-License-Identifier: Apache-2.0
#include "nadir/pipelines/flight/photo_pixels.hpp"

#include <map>
#include <mutex>

#include "nadir/io/photos/photo_file.hpp"

namespace nadir {

struct PhotoPixels::Store {
  int max_image_px = 0;
  std::size_t budget = 0;
  std::mutex mutex;
  std::map<std::filesystem::path, Raster<std::uint8_t>> kept;
};

PhotoPixels::PhotoPixels(int max_image_px, std::size_t budget_bytes)
    : store_(std::make_shared<Store>()) {
  store_->max_image_px = max_image_px;
  store_->budget = budget_bytes;
}

std::function<Raster<std::uint8_t>()> PhotoPixels::loader(const std::filesystem::path& file) const {
  return [store = store_, file] {
    {
      const std::lock_guard lock(store->mutex);
      const auto found = store->kept.find(file);
      if (found != store->kept.end()) return found->second;
    }
    Raster<std::uint8_t> image = read_photo(file, store->max_image_px).image;
    const std::lock_guard lock(store->mutex);
    if (image.values().size() <= store->budget && store->kept.emplace(file, image).second) {
      store->budget -= image.values().size();
    }
    return image;
  };
}

}  // namespace nadir
