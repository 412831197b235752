// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/image.hpp"

#include <fmt/format.h>

#include <limits>

#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/image_bytes.hpp"
#include "nadir/io/detail/image_view.hpp"
#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

/// OpenCV tells its troubles to stderr; here they travel in the Error.
void silence_opencv() { cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); }

cv::Mat decode(const std::filesystem::path& path, std::string& bytes) {
  // The stored pixels, whatever the EXIF orientation says: calibrations and world files refer to
  // them, and a resize leaves stale EXIF behind.
  constexpr int kStoredPixels =
      cv::IMREAD_ANYCOLOR | cv::IMREAD_ANYDEPTH | cv::IMREAD_IGNORE_ORIENTATION;
  try {
    if (bytes.size() > std::numeric_limits<int>::max()) {
      throw input_error(path, "the file is larger than 2 GiB", "cut the image into parts");
    }
    const cv::Mat encoded(1, static_cast<int>(bytes.size()), CV_8UC1, bytes.data());
    return cv::imdecode(encoded, kStoredPixels);
  } catch (const cv::Exception& exception) {
    throw input_error(path, "the image cannot be decoded: " + exception.err,
                      "check or convert it with an image program");
  }
}

cv::Mat in_opencv_order(Raster<std::uint8_t> image) {
  cv::Mat result;
  switch (image.channels()) {
    case 1:
      return view_of(image).clone();
    case 3:
      cv::cvtColor(view_of(image), result, cv::COLOR_RGB2BGR);
      return result;
    case 4:
      cv::cvtColor(view_of(image), result, cv::COLOR_RGBA2BGRA);
      return result;
    default:
      return result;
  }
}

}  // namespace

Raster<std::uint8_t> read_image(const std::filesystem::path& path) {
  return decode_image(path, read_file(path));
}

Raster<std::uint8_t> decode_image(const std::filesystem::path& path, std::string bytes) {
  silence_opencv();
  check_image_is_whole(path, bytes);
  check_image_size(path, bytes);
  const cv::Mat decoded = decode(path, bytes);
  if (decoded.empty()) {
    throw input_error(path, "is not an image that can be decoded",
                      "give a PNG, JPEG or TIFF file, or copy it again if it is damaged");
  }
  if (decoded.depth() != CV_8U) {
    throw input_error(path, "has more than 8 bits a channel",
                      fmt::format("convert it: gdal_translate -ot Byte -scale {} out.tif",
                                  shell_quoted_path(path)));
  }
  Raster<std::uint8_t> image(decoded.cols, decoded.rows, 0, decoded.channels());
  cv::Mat view = view_of(image);
  if (decoded.channels() == 1) {
    decoded.copyTo(view);
  } else {
    cv::cvtColor(decoded, view, cv::COLOR_BGR2RGB);
  }
  return image;
}

void write_png(const std::filesystem::path& path, const Raster<std::uint8_t>& image) {
  silence_opencv();
  const cv::Mat ordered = image.empty() ? cv::Mat{} : in_opencv_order(image);
  if (ordered.empty()) {
    throw Error(ErrorKind::kProcessing,
                fmt::format("an image of {} x {} pixels and {} channels cannot be a PNG",
                            image.width(), image.height(), image.channels()),
                path.string());
  }
  std::vector<std::uint8_t> encoded;
  try {
    // A third of the time of level 6: images come out a tenth smaller, drawings up to a half
    // larger.
    cv::imencode(
        ".png", ordered, encoded,
        {cv::IMWRITE_PNG_COMPRESSION, 1, cv::IMWRITE_PNG_STRATEGY, cv::IMWRITE_PNG_STRATEGY_RLE});
  } catch (const cv::Exception& exception) {
    throw Error(ErrorKind::kProcessing, "cannot be encoded: " + exception.err, path.string());
  }
  write_file(path, {reinterpret_cast<const char*>(encoded.data()), encoded.size()});
}

}  // namespace nadir
