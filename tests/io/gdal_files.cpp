// SPDX-License-Identifier: Apache-2.0
#include "io/gdal_files.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <ogr_spatialref.h>

#include <memory>
#include <stdexcept>

namespace nadir::test {
namespace {

struct Closer {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, Closer>;

void write_band(GDALRasterBand& band, int value, int width, int height) {
  std::vector<std::uint8_t> pixels(static_cast<std::size_t>(width * height),
                                   static_cast<std::uint8_t>(value));
  pixels.front() = 0;
  if (band.RasterIO(GF_Write, 0, 0, width, height, pixels.data(), width, height, GDT_Byte, 0, 0,
                    nullptr) != CE_None) {
    throw std::runtime_error("the test cannot write its file");
  }
}

}  // namespace

void write_tiff(const std::filesystem::path& path, const TiffRecipe& recipe) {
  GDALAllRegister();
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const Dataset dataset(driver->Create(path.c_str(), recipe.width, recipe.height, recipe.bands,
                                       recipe.type, nullptr));
  std::array<double, 6> transform = recipe.transform;
  dataset->SetGeoTransform(transform.data());
  if (recipe.epsg != 0) dataset->SetProjection(wkt_of_epsg(recipe.epsg).c_str());
  if (recipe.palette) {
    GDALColorTable colours;
    const GDALColorEntry red{255, 0, 0, 255};
    colours.SetColorEntry(0, &red);
    dataset->GetRasterBand(1)->SetColorTable(&colours);
  }
  for (const auto& [domain, name, value] : recipe.metadata) {
    dataset->SetMetadataItem(name.c_str(), value.c_str(), domain.c_str());
  }
  for (std::size_t i = 0; i < recipe.meaning.size(); ++i) {
    dataset->GetRasterBand(static_cast<int>(i) + 1)->SetColorInterpretation(recipe.meaning[i]);
  }
  for (std::size_t i = 0; i < recipe.values.size(); ++i) {
    GDALRasterBand& band = *dataset->GetRasterBand(static_cast<int>(i) + 1);
    if (recipe.nodata != nullptr) band.SetNoDataValue(CPLAtof(recipe.nodata));
    write_band(band, recipe.values[i], recipe.width, recipe.height);
  }
}

void write_sparse_tiff(const std::filesystem::path& path, int width, int height,
                       const std::vector<std::array<std::string, 2>>& options, bool sparse) {
  GDALAllRegister();
  CPLStringList list;
  if (sparse) list.SetNameValue("SPARSE_OK", "TRUE");
  for (const auto& [name, value] : options) list.SetNameValue(name.c_str(), value.c_str());
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const Dataset dataset(driver->Create(path.c_str(), width, height, 1, GDT_Byte, list.List()));
  std::array<double, 6> transform = TiffRecipe().transform;
  dataset->SetGeoTransform(transform.data());
}

TiffFacts tiff_facts(const std::filesystem::path& path) {
  const Dataset dataset(GDALDataset::Open(path.c_str(), GDAL_OF_RASTER));
  std::array<double, 6> transform{};
  dataset->GetGeoTransform(transform.data());
  int block_width = 0;
  int block_height = 0;
  dataset->GetRasterBand(1)->GetBlockSize(&block_width, &block_height);
  const char* compression = dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE");
  return {transform[0], transform[3], block_width, compression == nullptr ? "" : compression,
          dataset->GetRasterBand(1)->GetOverviewCount()};
}

std::string wkt_of_epsg(int code) {
  OGRSpatialReference crs;
  crs.importFromEPSG(code);
  char* text = nullptr;
  crs.exportToWkt(&text);
  std::string wkt = text;
  CPLFree(text);
  return wkt;
}

bool is_same_crs(const std::string& wkt_a, const std::string& wkt_b) {
  const OGRSpatialReference a(wkt_a.c_str());
  const OGRSpatialReference b(wkt_b.c_str());
  return a.IsSame(&b) != 0;
}

}  // namespace nadir::test
