// SPDX-License-Identifier: Apache-2.0
#include <cpl_string.h>
#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <vector>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/orthomosaic_file.hpp"

namespace nadir {
namespace {

Error write_error(const std::filesystem::path& path, const std::string& problem) {
  return {ErrorKind::kProcessing, "cannot be written: " + problem, path.string(),
          "check the folder, its permissions and the free space"};
}

void check(const Orthomosaic& orthomosaic, const std::filesystem::path& path) {
  const Raster<std::uint8_t>& image = orthomosaic.image;
  if (image.empty() || !image.same_size(orthomosaic.valid) || orthomosaic.valid.channels() != 1 ||
      (image.channels() != 1 && image.channels() != 3)) {
    throw Error(ErrorKind::kProcessing,
                fmt::format("an image of {} x {} pixels, {} channels, and a mask of {} x {} are no "
                            "orthomosaic",
                            image.width(), image.height(), image.channels(),
                            orthomosaic.valid.width(), orthomosaic.valid.height()),
                path.string());
  }
}

bool has_holes(const Orthomosaic& orthomosaic) {
  const auto& valid = orthomosaic.valid.values();
  return std::find(valid.begin(), valid.end(), std::uint8_t{0}) != valid.end();
}

/// The mask as files carry it: 0 and 255 only.
Raster<std::uint8_t> opacity(const Orthomosaic& orthomosaic) {
  Raster<std::uint8_t> mask = orthomosaic.valid;
  for (std::uint8_t& value : mask.values()) value = value == 0 ? 0 : 255;
  return mask;
}

bool write_band(GDALRasterBand* band, const Raster<std::uint8_t>& from, int channel) {
  if (band == nullptr) return false;
  const auto pixel_step = static_cast<GSpacing>(from.channels());
  // RasterIO takes one pointer for both directions; it only reads here.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
  auto* values = const_cast<std::uint8_t*>(from.values().data() + channel);
  return band->RasterIO(GF_Write, 0, 0, from.width(), from.height(), values, from.width(),
                        from.height(), GDT_Byte, pixel_step, pixel_step * from.width(),
                        nullptr) == CE_None;
}

bool write_colours(GDALDataset& dataset, const Raster<std::uint8_t>& image) {
  for (int channel = 0; channel < image.channels(); ++channel) {
    if (!write_band(dataset.GetRasterBand(channel + 1), image, channel)) return false;
  }
  return true;
}

void set_geo_reference(GDALDataset& dataset, const GeoReference& geo,
                       const std::filesystem::path& path) {
  std::array<double, 6> transform{geo.west, geo.resolution, 0.0, geo.north, 0.0, -geo.resolution};
  dataset.SetGeoTransform(transform.data());
  if (geo.crs.empty()) return;
  OGRSpatialReference crs;
  if (crs.SetFromUserInput(geo.crs.c_str()) != OGRERR_NONE) {
    throw Error(ErrorKind::kProcessing, "its coordinate reference system is not understood",
                path.string());
  }
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  dataset.SetSpatialRef(&crs);
}

/// Halved until the smallest side of the pyramid fits a screen tile.
bool build_overviews(GDALDataset& dataset) {
  constexpr int kLargestWithout = 1024;
  constexpr int kSmallestLevel = 256;
  const int size = std::max(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  if (size <= kLargestWithout) return true;
  std::vector<int> factors;
  for (int factor = 2; size / factor >= kSmallestLevel; factor *= 2) factors.push_back(factor);
  return dataset.BuildOverviews("AVERAGE", static_cast<int>(factors.size()), factors.data(), 0,
                                nullptr, nullptr, nullptr) == CE_None;
}

void write_geotiff(const std::filesystem::path& path, const Orthomosaic& orthomosaic) {
  AtomicFile file(path);
  GDALDriver& driver = gdal_driver("GTiff");
  const GdalErrors errors;
  const GdalSetting internal_mask("GDAL_TIFF_INTERNAL_MASK", "YES");
  const Raster<std::uint8_t>& image = orthomosaic.image;
  CPLStringList options;
  options.SetNameValue("TILED", "YES");
  options.SetNameValue("BLOCKXSIZE", "512");
  options.SetNameValue("BLOCKYSIZE", "512");
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("PREDICTOR", "2");
  options.SetNameValue("BIGTIFF", "IF_SAFER");
  options.SetNameValue("PHOTOMETRIC", image.channels() == 3 ? "RGB" : "MINISBLACK");
  GdalDataset dataset(driver.Create(file.temporary().c_str(), image.width(), image.height(),
                                    image.channels(), GDT_Byte, options.List()));
  if (!dataset) throw write_error(path, errors.first_failure());
  set_geo_reference(*dataset, orthomosaic.geo, path);
  bool written = write_colours(*dataset, image);
  if (written && has_holes(orthomosaic)) {
    written = dataset->CreateMaskBand(GMF_PER_DATASET) == CE_None &&
              write_band(dataset->GetRasterBand(1)->GetMaskBand(), opacity(orthomosaic), 0);
  }
  written = written && build_overviews(*dataset);
  dataset.reset();  // the last blocks are written, or fail to be, when it closes
  if (!written || errors.failed()) throw write_error(path, errors.first_failure());
  file.commit();
}

/// A world file names the centre of the first pixel, a geo-reference its outer corner.
std::string world_file(const GeoReference& geo) {
  return fmt::format("{}\n0\n0\n{}\n{}\n{}\n", to_text(geo.resolution), to_text(-geo.resolution),
                     to_text(geo.x_at(0.5)), to_text(geo.y_at(0.5)));
}

void encode_png(const std::filesystem::path& temporary, const Orthomosaic& orthomosaic,
                const std::filesystem::path& path) {
  GDALDriver& memory = gdal_driver("MEM");
  const GdalErrors errors;
  const GdalSetting no_side_files("GDAL_PAM_ENABLED", "NO");
  const Raster<std::uint8_t>& image = orthomosaic.image;
  const int alpha = image.channels() + 1;
  const GdalDataset pixels(
      memory.Create("", image.width(), image.height(), alpha, GDT_Byte, nullptr));
  bool written = pixels != nullptr && write_colours(*pixels, image) &&
                 write_band(pixels->GetRasterBand(alpha), opacity(orthomosaic), 0);
  if (written) {
    pixels->GetRasterBand(alpha)->SetColorInterpretation(GCI_AlphaBand);
    GdalDataset png(gdal_driver("PNG").CreateCopy(temporary.c_str(), pixels.get(), 0, nullptr,
                                                  nullptr, nullptr));
    written = png != nullptr;
  }
  if (!written || errors.failed()) throw write_error(path, errors.first_failure());
}

void write_png_with_world_file(const std::filesystem::path& path, const Orthomosaic& orthomosaic) {
  AtomicFile png(path);
  AtomicFile world(std::filesystem::path(path).replace_extension(".pgw"));
  AtomicFile crs(std::filesystem::path(path).replace_extension(".prj"));
  encode_png(png.temporary(), orthomosaic, path);
  world.write(world_file(orthomosaic.geo));
  if (orthomosaic.geo.crs.empty()) {
    remove_file(crs.target());  // of an image that this one replaces
  } else {
    crs.write(orthomosaic.geo.crs + "\n");
    crs.commit();
  }
  world.commit();
  png.commit();
}

}  // namespace

void write_orthomosaic(const std::filesystem::path& path, const Orthomosaic& orthomosaic) {
  check(orthomosaic, path);
  const std::string extension = path.extension().string();
  if (extension == ".tif" || extension == ".tiff") {
    write_geotiff(path, orthomosaic);
  } else if (extension == ".png") {
    write_png_with_world_file(path, orthomosaic);
  } else {
    throw Error(ErrorKind::kUsage, "'" + extension + "' is no format for an orthomosaic",
                path.string(), "write .tif or .png");
  }
}

}  // namespace nadir
