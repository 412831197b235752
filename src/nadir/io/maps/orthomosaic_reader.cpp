// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <span>
#include <stdexcept>

#include "nadir/io/detail/raster_file.hpp"
#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/detail/gdal_geo_reference.hpp"
#include "nadir/io/maps/detail/orthomosaic_bands.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

void check_pixel_type(GDALDataset& dataset, const std::filesystem::path& path) {
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    GDALRasterBand& band = *dataset.GetRasterBand(number);
    if (band.GetColorTable() != nullptr) {
      throw input_error(path, "its colours are a palette", translate_line(path, "-expand rgb"));
    }
    if (dataset.GetRasterCount() == 1 && GDALDataTypeIsFloating(band.GetRasterDataType()) != 0) {
      throw input_error(path, "its pixels are numbers as heights are, not colours",
                        "give the orthomosaic here, and a surface model as a surface");
    }
    const char* bits = band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE");
    if (band.GetRasterDataType() != GDT_Byte || bits != nullptr) {
      throw input_error(
          path,
          fmt::format("its pixels are {}{}, 8-bit channels are needed",
                      bits == nullptr ? GDALGetDataTypeName(band.GetRasterDataType()) : bits,
                      bits == nullptr ? "" : "-bit"),
          translate_line(path, "-ot Byte -scale"));
    }
  }
}

GeoReference geo_reference(GDALDataset& dataset, const std::filesystem::path& path,
                           std::optional<PlainImageGeo> plain) {
  if (auto geo = read_geo_reference(dataset, path)) return *geo;
  if (!plain) {
    throw input_error(path, "it has no geo-reference",
                      "give its metres per pixel, or put a world file beside it");
  }
  if (!(plain->metres_per_pixel > 0.0)) {
    throw Error(ErrorKind::kUsage, "metres per pixel must be above 0", path.string());
  }
  return {0.0, dataset.GetRasterYSize() * plain->metres_per_pixel, plain->metres_per_pixel, {}};
}

}  // namespace

std::string translate_line(const std::filesystem::path& path, const std::string& arguments) {
  return fmt::format("convert it: gdal_translate {} {} out.tif", arguments,
                     shell_quoted_path(path));
}

/// Compressed images are decoded without a word where they end too early.
void check_orthomosaic_file(const std::filesystem::path& path) {
  if (!is_file(path)) return;  // opening it says so
  const std::string extension = lower_extension(path);
  if (extension == ".png" || extension == ".jpg" || extension == ".jpeg") {
    check_image_is_whole(path, read_file(path));
  }
}

std::vector<int> colour_bands(GDALDataset& dataset, const std::filesystem::path& path) {
  std::array<int, 3> rgb{};
  std::vector<int> colours;
  for (int number = 1; number <= dataset.GetRasterCount(); ++number) {
    const GDALColorInterp meaning = dataset.GetRasterBand(number)->GetColorInterpretation();
    if (meaning == GCI_AlphaBand) continue;
    if (meaning >= GCI_CyanBand && meaning <= GCI_BlackBand) {
      throw input_error(path, "its colours are CMYK, RGB is needed",
                        "convert it with an image program (for example `magick IN -colorspace "
                        "sRGB OUT`)");
    }
    if (meaning >= GCI_RedBand && meaning <= GCI_BlueBand) {
      rgb[static_cast<std::size_t>(meaning - GCI_RedBand)] = number;
    }
    colours.push_back(number);
  }
  if (colours.size() != 1 && colours.size() != 3) {
    throw input_error(
        path, fmt::format("it has {} colour bands, 1 (grey) or 3 (RGB) are needed", colours.size()),
        translate_line(path, "-b 1 -b 2 -b 3") + " (or `-colorinterp_4 alpha` for a fourth)");
  }
  const bool named = std::find(rgb.begin(), rgb.end(), 0) == rgb.end();
  return named ? std::vector<int>(rgb.begin(), rgb.end()) : colours;
}

void read_band(GDALRasterBand& band, Raster<std::uint8_t>& into, int channel,
               const std::filesystem::path& path, const GdalErrors& errors) {
  const auto pixel_step = static_cast<GSpacing>(into.channels());
  const CPLErr result = band.RasterIO(GF_Read, 0, 0, into.width(), into.height(),
                                      into.values().data() + channel, into.width(), into.height(),
                                      GDT_Byte, pixel_step, pixel_step * into.width(), nullptr);
  if (result != CE_None || errors.failed()) {
    throw input_error(path, "its pixels cannot be read: " + errors.first_failure(),
                      "copy or make it again, it is cut off or damaged");
  }
}

Raster<std::uint8_t> read_validity(GDALDataset& dataset, std::span<const int> bands,
                                   const std::filesystem::path& path, const GdalErrors& errors) {
  const int width = dataset.GetRasterXSize();
  const int height = dataset.GetRasterYSize();
  const int flags = dataset.GetRasterBand(bands[0])->GetMaskFlags();
  if ((flags & GMF_ALL_VALID) != 0) return {width, height, kSeen};
  const std::size_t masks = (flags & GMF_PER_DATASET) != 0 ? 1 : bands.size();

  Raster<std::uint8_t> valid(width, height);
  Raster<std::uint8_t> mask(width, height);
  for (const int number : bands.first(masks)) {
    read_band(*dataset.GetRasterBand(number)->GetMaskBand(), mask, 0, path, errors);
    std::transform(
        mask.values().begin(), mask.values().end(), valid.values().begin(), valid.values().begin(),
        [](std::uint8_t seen, std::uint8_t before) { return seen != 0 ? kSeen : before; });
  }
  return valid;
}

Orthomosaic read_orthomosaic(const std::filesystem::path& path,
                             std::optional<PlainImageGeo> plain) {
  check_orthomosaic_file(path);
  const GdalErrors errors;
  const GdalSetting strict("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");
  const GdalDataset dataset = open_raster(path, errors);
  check_raster_size(*dataset, path);
  check_pixel_type(*dataset, path);
  const std::vector<int> bands = colour_bands(*dataset, path);
  const int width = dataset->GetRasterXSize();
  const int height = dataset->GetRasterYSize();
  Orthomosaic result;
  result.geo = geo_reference(*dataset, path, plain);
  try {
    result.image = Raster<std::uint8_t>(width, height, 0, static_cast<int>(bands.size()));
    for (std::size_t i = 0; i < bands.size(); ++i) {
      read_band(*dataset->GetRasterBand(bands[i]), result.image, static_cast<int>(i), path, errors);
    }
    result.valid = read_validity(*dataset, bands, path, errors);
  } catch (const std::bad_alloc&) {
    throw input_error(path, fmt::format("{} x {} pixels do not fit in memory", width, height),
                      translate_line(path, "-outsize 50% 50%"));
  }
  return result;
}

}  // namespace nadir
