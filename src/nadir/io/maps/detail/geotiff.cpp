// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/detail/geotiff.hpp"

#include <cpl_string.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <vector>

#include "nadir/io/detail/reference_system.hpp"

namespace nadir {
namespace {

void set_geo_reference(GDALDataset& dataset, const GeoReference& geo,
                       const std::filesystem::path& path) {
  std::array<double, 6> transform{geo.west, geo.resolution, 0.0, geo.north, 0.0, -geo.resolution};
  dataset.SetGeoTransform(transform.data());
  if (geo.crs.empty()) return;
  OGRSpatialReference crs;
  if (!set_reference_system(geo.crs, crs)) {
    throw Error(ErrorKind::kProcessing, "its coordinate reference system is not understood",
                path.string());
  }
  dataset.SetSpatialRef(&crs);
}

}  // namespace

GdalDataset create_geotiff(const std::string& temporary, const GeoTiffShape& shape,
                           const GeoReference& geo, const std::filesystem::path& path,
                           const GdalErrors& errors) {
  const bool floating = shape.type == GDT_Float32 || shape.type == GDT_Float64;
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", "512");
  options.SetNameValue("BLOCKYSIZE", "512");
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", floating ? "3" : "2");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  options.SetNameValue("PHOTOMETRIC", shape.bands == 3 ? "RGB" : "MINISBLACK");
  GdalDataset dataset(gdal_driver("GTiff").Create(temporary.c_str(), shape.width, shape.height,
                                                  shape.bands, shape.type, options.List()));
  if (!dataset) throw write_error(path, errors.first_failure());
  set_geo_reference(*dataset, geo, path);
  return dataset;
}

bool build_overviews(GDALDataset& dataset) {
  constexpr int kLargestWithout = 1024;
  constexpr int kSmallestLevel = 256;  // the smallest side of the pyramid fits a screen tile
  const int size = std::max(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  if (size <= kLargestWithout) return true;
  std::vector<int> factors;
  for (int factor = 2; size / factor >= kSmallestLevel; factor *= 2) factors.push_back(factor);
  return dataset.BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                                nullptr, nullptr, nullptr) == CE_None;
}

Error write_error(const std::filesystem::path& path, const std::string& problem) {
  return {ErrorKind::kProcessing, "cannot be written: " + problem, path.string(),
          "check the folder, its permissions and the free space"};
}

}  // namespace nadir
