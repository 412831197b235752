// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/map_tiles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <map>
#include <mutex>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>

#include "nadir/io/detail/raster_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/detail/gdal_geo_reference.hpp"

namespace nadir {
namespace {

constexpr std::size_t kCacheBytes = std::size_t{48} << 20U;

/// A window of the file, in its pixels, and the size at which it is wanted.
struct Window {
  int left = 0;
  int top = 0;
  int width = 0;
  int height = 0;
  int tile_width = 0;
  int tile_height = 0;
};

cv::Mat read_window(GDALRasterBand& band, const Window& window, const std::filesystem::path& path) {
  cv::Mat pixels(window.tile_height, window.tile_width, CV_8U);
  GDALRasterIOExtraArg how;
  INIT_RASTERIO_EXTRA_ARG(how);
  how.eResampleAlg = GRIORA_Average;
  const GdalErrors errors;
  if (band.RasterIO(GF_Read, window.left, window.top, window.width, window.height, pixels.data,
                    window.tile_width, window.tile_height, GDT_Byte, 1,
                    static_cast<GSpacing>(pixels.step), &how) != CE_None) {
    throw input_error(path, "its pixels cannot be read: " + errors.first_failure(),
                      "copy or make it again, it is cut off or damaged");
  }
  return pixels;
}

EncodedImage encode(const cv::Mat& colours, const cv::Mat& mask) {
  std::vector<std::uint8_t> bytes;
  EncodedImage image;
  if (cv::countNonZero(mask) == static_cast<int>(mask.total())) {
    image.media_type = "image/jpeg";
    cv::imencode(".jpg", colours, bytes, {cv::IMWRITE_JPEG_QUALITY, 88});
  } else {
    image.media_type = "image/png";
    std::vector<cv::Mat> planes;
    cv::split(colours, planes);
    if (planes.size() == 1) planes = {planes[0], planes[0], planes[0]};
    planes.push_back(mask != 0);
    cv::Mat with_alpha;
    cv::merge(planes, with_alpha);
    cv::imencode(".png", with_alpha, bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
  }
  image.bytes.assign(bytes.begin(), bytes.end());
  return image;
}

}  // namespace

struct MapTiles::Source {
  /// The newest encoded tiles, up to kCacheBytes.
  class TileCache {
   public:
    using Key = std::tuple<int, int, int>;

    const EncodedImage* find(const Key& key) {
      const auto found = places_.find(key);
      if (found == places_.end()) return nullptr;
      order_.splice(order_.begin(), order_, found->second);
      return &found->second->second;
    }

    void insert(const Key& key, EncodedImage image) {
      bytes_ += image.bytes.size();
      order_.emplace_front(key, std::move(image));
      places_[key] = order_.begin();
      while (bytes_ > kCacheBytes && order_.size() > 1) {
        bytes_ -= order_.back().second.bytes.size();
        places_.erase(order_.back().first);
        order_.pop_back();
      }
    }

   private:
    std::list<std::pair<Key, EncodedImage>> order_;
    std::map<Key, decltype(order_)::iterator> places_;
    std::size_t bytes_ = 0;
  };

  std::filesystem::path path;
  GdalDataset dataset;
  std::vector<int> bands;  ///< blue, green, red; or grey
  std::mutex mutex;        ///< a GDAL dataset serves one thread at a time
  TileCache cache;
};

MapTiles::MapTiles(const std::filesystem::path& path) : source_(std::make_unique<Source>()) {
  const GdalErrors errors;
  source_->path = path;
  source_->dataset = open_raster(path, errors);
  check_block_size(*source_->dataset, path);
  const auto geo = read_geo_reference(*source_->dataset, path);
  if (!geo) throw input_error(path, "it has no geo-reference", "put a world file beside it");
  geo_ = *geo;
  width_ = source_->dataset->GetRasterXSize();
  height_ = source_->dataset->GetRasterYSize();
  source_->bands = source_->dataset->GetRasterCount() >= 3 ? std::vector{3, 2, 1} : std::vector{1};
  while (std::max(width_, height_) > kTileSize << (levels_ - 1)) ++levels_;
}

MapTiles::~MapTiles() = default;

std::optional<EncodedImage> MapTiles::tile(int level, int column, int row) {
  if (level < 0 || level >= levels_ || column < 0 || row < 0) return std::nullopt;
  const int factor = 1 << (levels_ - 1 - level);
  const std::int64_t side = std::int64_t{kTileSize} * factor;
  if (column * side >= width_ || row * side >= height_) return std::nullopt;

  const std::scoped_lock lock(source_->mutex);
  const Source::TileCache::Key key{level, column, row};
  if (const EncodedImage* cached = source_->cache.find(key)) return *cached;
  Window window;
  window.left = static_cast<int>(column * side);
  window.top = static_cast<int>(row * side);
  window.width = static_cast<int>(std::min<std::int64_t>(side, width_ - window.left));
  window.height = static_cast<int>(std::min<std::int64_t>(side, height_ - window.top));
  window.tile_width = (window.width + factor - 1) / factor;
  window.tile_height = (window.height + factor - 1) / factor;

  std::vector<cv::Mat> planes;
  for (const int band : source_->bands) {
    planes.push_back(read_window(*source_->dataset->GetRasterBand(band), window, source_->path));
  }
  GDALRasterBand& mask = *source_->dataset->GetRasterBand(source_->bands.front())->GetMaskBand();
  cv::Mat colours;
  cv::merge(planes, colours);
  // A tile at the east or south edge is filled up, so that all are of one size.
  cv::Mat full(kTileSize, kTileSize, colours.type(), cv::Scalar::all(0));
  cv::Mat full_mask(kTileSize, kTileSize, CV_8U, cv::Scalar(0));
  const cv::Rect used(0, 0, window.tile_width, window.tile_height);
  colours.copyTo(full(used));
  read_window(mask, window, source_->path).copyTo(full_mask(used));
  EncodedImage image = encode(full, full_mask);
  source_->cache.insert(key, image);
  return image;
}

}  // namespace nadir
