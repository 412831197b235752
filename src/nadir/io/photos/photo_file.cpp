// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/photos/photo_file.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/image_view.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/photos/detail/exif.hpp"

namespace nadir {
namespace {

Raster<std::uint8_t> reduced(Raster<std::uint8_t> image, int max_image_px) {
  const ImageSize size = reduced_size(image.width(), image.height(), max_image_px);
  if (size.width == image.width() && size.height == image.height()) return image;
  Raster<std::uint8_t> small(size.width, size.height, 0, image.channels());
  cv::Mat into = view_of(small);
  cv::resize(view_of(image), into, into.size(), 0.0, 0.0, cv::INTER_AREA);
  return small;
}

std::string encode_jpeg(const std::filesystem::path& path, const Photo& photo, int quality) {
  Raster<std::uint8_t> image = photo.image;
  const bool encodable = !image.empty() && (image.channels() == 1 || image.channels() == 3);
  std::vector<std::uint8_t> bytes;
  if (encodable) {
    cv::Mat ordered = view_of(image);
    if (image.channels() == 3) cv::cvtColor(ordered, ordered, cv::COLOR_RGB2BGR);
    cv::imencode(".jpg", ordered, bytes, {cv::IMWRITE_JPEG_QUALITY, std::clamp(quality, 1, 100)});
  }
  if (bytes.empty()) {
    throw Error(ErrorKind::kProcessing,
                "an image of " + std::to_string(image.width()) + " x " +
                    std::to_string(image.height()) + " pixels, " +
                    std::to_string(image.channels()) + " channels, cannot be a JPEG",
                path.string());
  }
  return {bytes.begin(), bytes.end()};
}

/// Whether a file, or a folder on the way to it, is hidden: no photo, but what a writer has not
/// finished (UnfinishedFolder), say.
bool is_hidden(const std::filesystem::path& file, const std::filesystem::path& folder) {
  const std::filesystem::path below = file.lexically_relative(folder);
  return std::any_of(below.begin(), below.end(), [](const std::filesystem::path& part) {
    return part.string().starts_with('.');
  });
}

}  // namespace

std::vector<std::filesystem::path> photo_files(const std::filesystem::path& folder) {
  static const std::set<std::string> jpeg{".jpg", ".jpeg"};
  static const std::set<std::string> others{".png", ".tif", ".tiff"};
  for (const Depth depth : {Depth::kFolder, Depth::kAllBelow}) {
    for (const auto& extensions : {jpeg, others}) {
      std::vector<std::filesystem::path> files = files_in(folder, depth);
      std::erase_if(files, [&](const auto& file) {
        return !extensions.contains(lower_extension(file)) || is_hidden(file, folder);
      });
      if (!files.empty()) return files;
    }
  }
  throw input_error(folder, "holds no photos", "give a folder of JPEG, PNG or TIFF photos");
}

ImageSize reduced_size(int width, int height, int max_image_px) {
  const int longer = std::max(width, height);
  if (max_image_px <= 0 || longer <= max_image_px) return {width, height};
  const double scale = static_cast<double>(max_image_px) / longer;
  const auto side = [&](int size) {
    return std::max(1, static_cast<int>(std::lround(size * scale)));
  };
  return {side(width), side(height)};
}

Photo read_photo(const std::filesystem::path& path, int max_image_px) {
  Photo photo;
  photo.metadata = read_photo_metadata(path);
  photo.image = reduced(read_image(path), max_image_px);
  return photo;
}

void write_photo(const std::filesystem::path& path, const Photo& photo, int jpeg_quality) {
  const std::string extension = lower_extension(path);
  if (extension != ".jpg" && extension != ".jpeg") {
    throw Error(ErrorKind::kUsage, "'" + extension + "' is no format for a photo", path.string(),
                "write .jpg");
  }
  std::string jpeg = encode_jpeg(path, photo, jpeg_quality);
  PhotoMetadata metadata = photo.metadata;
  metadata.width = photo.image.width();
  metadata.height = photo.image.height();
  // EXIF asks to stand right behind the start marker.
  jpeg.insert(2, exif_segment(metadata) + xmp_segment(metadata));
  write_file(path, jpeg);
}

}  // namespace nadir
