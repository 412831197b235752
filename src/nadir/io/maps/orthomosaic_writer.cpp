// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>

#include "nadir/core/error.hpp"
#include "nadir/core/options.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/maps/detail/geotiff.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"

namespace nadir {
namespace {

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

void write_geotiff(const std::filesystem::path& path, const Orthomosaic& orthomosaic) {
  AtomicFile file(path);
  const GdalErrors errors;
  const GdalSetting internal_mask("GDAL_TIFF_INTERNAL_MASK", "YES");
  const Raster<std::uint8_t>& image = orthomosaic.image;
  GdalDataset dataset = create_geotiff(file.temporary().string(),
                                       {image.width(), image.height(), image.channels(), GDT_Byte},
                                       orthomosaic.geo, path, errors);
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
