// SPDX-License-Identifier: Apache-2.0
#include "fuzz/fuzz_raster.hpp"

#include <cstdint>

#include "nadir/core/error.hpp"
#include "nadir/io/detail/raster_file.hpp"

namespace nadir::fuzz {

bool is_small_raster(const std::filesystem::path& file) {
  constexpr std::int64_t kMostValues = 4'000'000;
  const GdalErrors errors;
  try {
    const GdalDataset dataset = open_raster(file, errors);
    return std::int64_t{dataset->GetRasterXSize()} * dataset->GetRasterYSize() *
               dataset->GetRasterCount() <=
           kMostValues;
  } catch (const Error&) {
    return true;  // the reader is to say so
  }
}

}  // namespace nadir::fuzz
