// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/gdal_support.hpp"

#include <mutex>

#include "nadir/core/error.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {

void GdalErrors::collect(CPLErr level, CPLErrorNum /*number*/, const char* message) {
  auto* self = static_cast<GdalErrors*>(CPLGetErrorHandlerUserData());
  if (level < CE_Failure || self->failed_) return;
  self->failed_ = true;
  self->first_failure_ = message;
}

void check_block_size(GDALDataset& dataset, const std::filesystem::path& path) {
  constexpr std::int64_t kLarge = std::int64_t{1} << 26U;
  const std::int64_t pixels =
      std::int64_t{dataset.GetRasterXSize()} * std::int64_t{dataset.GetRasterYSize()};
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    int width = 0;
    int height = 0;
    dataset.GetRasterBand(number)->GetBlockSize(&width, &height);
    const std::int64_t block = std::int64_t{width} * std::int64_t{height};
    if (block <= kLarge || block <= pixels) continue;
    throw input_error(path,
                      "its header declares blocks of " + std::to_string(width) + " x " +
                          std::to_string(height) + " pixels",
                      "the header is damaged: copy or make it again");
  }
}

void check_raster_size(GDALDataset& dataset, const std::filesystem::path& path) {
  const std::int64_t width = dataset.GetRasterXSize();
  const std::int64_t height = dataset.GetRasterYSize();
  if (width * height > kMostRasterPixels) {
    throw input_error(path,
                      "it has " + std::to_string(width) + " x " + std::to_string(height) +
                          " pixels, more than the " + std::to_string(kMostRasterPixels) +
                          " that can be read",
                      "cut it into parts, or reduce it: gdal_translate -outsize 50% 50% " +
                          path.string() + " out.tif");
  }
  check_block_size(dataset, path);
}

GDALDriver& gdal_driver(const char* name) {
  static std::once_flag registered;
  std::call_once(registered, [] {
    const GdalErrors quiet;  // a plugin that cannot be loaded matters only to who needs it
    GDALAllRegister();
  });
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName(name);
  if (driver == nullptr) {
    throw Error(ErrorKind::kProcessing, "GDAL was built without its driver", name,
                "install a complete GDAL");
  }
  return *driver;
}

}  // namespace nadir
