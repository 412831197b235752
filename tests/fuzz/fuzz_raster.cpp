// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_raster.hpp"

#include <gdal_priv.h>

#include <cstdint>
#include <memory>
#include <mutex>

namespace nadir::fuzz {

bool is_small_raster(const std::filesystem::path& file) {
  constexpr std::int64_t kMostValues = 4'000'000;
  static std::once_flag registered;
  std::call_once(registered, GDALAllRegister);
  CPLPushErrorHandler(CPLQuietErrorHandler);
  const std::unique_ptr<GDALDataset> dataset(
      GDALDataset::Open(file.c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY));
  CPLPopErrorHandler();
  if (!dataset) return true;  // the reader is to say so
  return std::int64_t{dataset->GetRasterXSize()} * dataset->GetRasterYSize() *
             dataset->GetRasterCount() <=
         kMostValues;
}

}  // namespace nadir::fuzz
