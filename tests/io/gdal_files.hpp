// SPDX-License-Identifier: Apache-2.0
#pragma once

// Files and facts straight from GDAL, independent of what is tested.

#include <gdal_priv.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace nadir::test {

/// What a test wants in a GeoTIFF.
struct TiffRecipe {
  int width = 4;
  int height = 3;
  int bands = 1;
  GDALDataType type = GDT_Byte;
  std::array<double, 6> transform{1000.0, 0.5, 0.0, 2000.0, 0.0, -0.5};
  int epsg = 0;               ///< 0 = none
  std::vector<int> values{};  ///< one per band, for all its pixels; first pixel stays 0
  const char* nodata = nullptr;
  std::vector<GDALColorInterp> meaning{};  ///< of the bands
  bool palette = false;
  /// Domain, name and value.
  std::vector<std::array<std::string, 3>> metadata{};
};

void write_tiff(const std::filesystem::path& path, const TiffRecipe& recipe);

/// One band of 8 bits with the transform of a TiffRecipe, by the options of GDAL's driver. Without
/// pixels, which are 0 then, or with zeros.
void write_sparse_tiff(const std::filesystem::path& path, int width, int height,
                       const std::vector<std::array<std::string, 2>>& options, bool sparse = true);

struct TiffFacts {
  double west = 0.0;
  double north = 0.0;
  int block_size = 0;
  std::string compression;
  int overviews = 0;
};

TiffFacts tiff_facts(const std::filesystem::path& path);

std::string wkt_of_epsg(int code);
bool is_same_crs(const std::string& wkt_a, const std::string& wkt_b);

}  // namespace nadir::test
