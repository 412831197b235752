// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/elevation_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/raster_file.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/detail/gdal_geo_reference.hpp"
#include "nadir/io/maps/detail/geotiff.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

/// No height on Earth, and what surface models mostly use.
constexpr float kNodata = -9999.0F;
constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();

GdalDataset open(const std::filesystem::path& path, const GdalErrors& errors) {
  GdalDataset dataset = open_raster(path, errors);
  check_raster_size(*dataset, path);
  if (dataset->GetRasterCount() != 1) {
    throw input_error(
        path, fmt::format("it has {} bands, heights are one", dataset->GetRasterCount()),
        fmt::format("pick one: gdal_translate -b 1 {} out.tif", shell_quoted_path(path)));
  }
  return dataset;
}

/// The band's values, with NaN where its mask (nodata, mask band) says that there is none.
Raster<float> read_heights(GDALRasterBand& band, const std::filesystem::path& path,
                           const GdalErrors& errors) {
  Raster<float> heights(band.GetXSize(), band.GetYSize());
  Raster<std::uint8_t> mask(band.GetXSize(), band.GetYSize());
  const auto read = [&](GDALRasterBand& from, void* into, GDALDataType type) {
    return from.RasterIO(GF_Read, 0, 0, heights.width(), heights.height(), into, heights.width(),
                         heights.height(), type, 0, 0, nullptr) == CE_None;
  };
  if (!read(band, heights.values().data(), GDT_Float32) ||
      !read(*band.GetMaskBand(), mask.values().data(), GDT_Byte) || errors.failed()) {
    throw input_error(path, "its values cannot be read: " + errors.first_failure(),
                      "copy or make it again, it is cut off or damaged");
  }
  std::transform(heights.values().begin(), heights.values().end(), mask.values().begin(),
                 heights.values().begin(), [](float height, std::uint8_t known) {
                   return known != 0 && std::isfinite(height) ? height : kUnknown;
                 });
  return heights;
}

}  // namespace

bool looks_like_heights(const std::filesystem::path& path) {
  const GdalErrors errors;
  try {
    const GdalDataset dataset = open_raster(path, errors);
    if (dataset->GetRasterCount() != 1) return false;
    return GDALDataTypeIsFloating(dataset->GetRasterBand(1)->GetRasterDataType()) != 0 ||
           lower_extension(path) == ".asc";
  } catch (const Error&) {
    return false;
  }
}

ElevationMap read_elevation_map(const std::filesystem::path& path) {
  const GdalErrors errors;
  const GdalDataset dataset = open(path, errors);
  const auto geo = read_geo_reference(*dataset, path);
  if (!geo) {
    throw input_error(path, "it has no geo-reference", "put a world file beside it");
  }
  ElevationMap elevation{read_heights(*dataset->GetRasterBand(1), path, errors), *geo};
  if (std::ranges::all_of(elevation.height_m.values(), [](float h) { return std::isnan(h); })) {
    throw input_error(path, "it holds no height: every value is nodata",
                      "check its nodata value with gdalinfo");
  }
  return elevation;
}

void write_elevation_map(const std::filesystem::path& path, const ElevationMap& elevation) {
  if (path.extension() != ".tif") {
    throw Error(ErrorKind::kUsage, "'" + path.extension().string() + "' is no format for heights",
                path.string(), "write .tif");
  }
  if (elevation.height_m.empty() || elevation.height_m.channels() != 1) {
    throw Error(ErrorKind::kProcessing, "an elevation map is one channel of at least one pixel",
                path.string());
  }
  AtomicFile file(path);
  const GdalErrors errors;
  GdalDataset dataset = create_geotiff(file.temporary().string(),
                                       {elevation.width(), elevation.height(), 1, GDT_Float32},
                                       elevation.geo, path, errors);
  Raster<float> values = elevation.height_m;
  for (float& value : values.values()) value = std::isfinite(value) ? value : kNodata;
  GDALRasterBand& band = *dataset->GetRasterBand(1);
  bool written =
      band.SetNoDataValue(kNodata) == CE_None &&
      band.RasterIO(GF_Write, 0, 0, values.width(), values.height(), values.values().data(),
                    values.width(), values.height(), GDT_Float32, 0, 0, nullptr) == CE_None;
  written = written && build_overviews(*dataset);
  dataset.reset();  // the last blocks are written, or fail to be, when it closes
  if (!written || errors.failed()) throw write_error(path, errors.first_failure());
  file.commit();
}

}  // namespace nadir
