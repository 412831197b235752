// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/orthomosaic_import.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "nadir/io/detail/raster_file.hpp"
#include "nadir/io/detail/reference_system.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/maps/detail/gdal_geo_reference.hpp"
#include "nadir/io/maps/detail/gdal_warp.hpp"
#include "nadir/io/maps/detail/orthomosaic_bands.hpp"

namespace nadir {
namespace {

using Path = std::filesystem::path;

constexpr int kCollarTolerance = 5;  // grey levels; JPEG bends pure white and black

/// The scale that the options give an image without a geo-reference.
std::optional<double> given_scale(const ImportOptions& options) {
  if (options.points_px.has_value() != options.distance_m.has_value()) {
    throw Error(ErrorKind::kUsage, "two points and their distance belong together", "--points",
                "give --points X1,Y1,X2,Y2 and --distance METRES");
  }
  if (options.metres_per_pixel && options.points_px) {
    throw Error(ErrorKind::kUsage, "the scale is given twice", "--metres-per-pixel",
                "give it, or --points with --distance");
  }
  if (options.metres_per_pixel) return options.metres_per_pixel;
  if (!options.points_px) return std::nullopt;
  const auto& [x1, y1, x2, y2] = *options.points_px;
  const double pixels = std::hypot(x2 - x1, y2 - y1);
  if (!(pixels >= 1.0) || !(*options.distance_m > 0.0)) {
    throw Error(ErrorKind::kUsage, "the two points are one, or their distance is not above 0",
                "--points", "take two places far apart");
  }
  return *options.distance_m / pixels;
}

/// The value below which this share of a sorted list lies.
float percentile(const std::vector<float>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

/// The stretch of pixels that are not 8-bit: the same for all colours, so that they keep their hue.
struct Stretch {
  float low = 0.0F;
  float high = 255.0F;
};

std::vector<float> band_values(GDALRasterBand& band, const Path& path, const GdalErrors& errors) {
  std::vector<float> values(static_cast<std::size_t>(band.GetXSize()) *
                            static_cast<std::size_t>(band.GetYSize()));
  if (band.RasterIO(GF_Read, 0, 0, band.GetXSize(), band.GetYSize(), values.data(), band.GetXSize(),
                    band.GetYSize(), GDT_Float32, 0, 0, nullptr) != CE_None) {
    throw input_error(path, "its pixels cannot be read: " + errors.first_failure(),
                      "copy or make it again, it is cut off or damaged");
  }
  return values;
}

Stretch stretch_of(const std::vector<std::vector<float>>& bands,
                   const Raster<std::uint8_t>& valid) {
  constexpr std::size_t kSample = 500'000;
  std::vector<float> values;
  const std::size_t step = std::max<std::size_t>(1, valid.values().size() / kSample);
  for (const std::vector<float>& band : bands) {
    for (std::size_t i = 0; i < band.size(); i += step) {
      if (valid.values()[i] != 0 && std::isfinite(band[i])) values.push_back(band[i]);
    }
  }
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  Stretch stretch{percentile(values, 0.01), percentile(values, 0.99)};
  if (!(stretch.high > stretch.low)) stretch.high = stretch.low + 1.0F;
  return stretch;
}

bool is_8_bit(GDALDataset& dataset, const std::vector<int>& bands) {
  return std::all_of(bands.begin(), bands.end(), [&](int number) {
    GDALRasterBand& band = *dataset.GetRasterBand(number);
    return band.GetRasterDataType() == GDT_Byte &&
           band.GetMetadataItem("NBITS", "IMAGE_STRUCTURE") == nullptr;
  });
}

void read_stretched(GDALDataset& dataset, const std::vector<int>& numbers, const Path& path,
                    const GdalErrors& errors, ImportedOrthomosaic& result) {
  std::vector<std::vector<float>> bands;
  for (const int number : numbers) {
    bands.push_back(band_values(*dataset.GetRasterBand(number), path, errors));
  }
  const Stretch stretch = stretch_of(bands, result.map.valid);
  for (std::size_t channel = 0; channel < bands.size(); ++channel) {
    for (std::size_t i = 0; i < bands[channel].size(); ++i) {
      const float share = (bands[channel][i] - stretch.low) / (stretch.high - stretch.low);
      result.map.image.values()[i * bands.size() + channel] =
          std::isfinite(share)
              ? static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(share, 0.0F, 1.0F)))
              : std::uint8_t{0};
    }
  }
  result.notes.push_back(fmt::format(
      "its pixels are {}: the 1st to 99th percentile ({:.6g} .. {:.6g}) became 0 .. 255",
      GDALGetDataTypeName(dataset.GetRasterBand(numbers[0])->GetRasterDataType()), stretch.low,
      stretch.high));
}

void read_pixels(GDALDataset& dataset, const Path& path, const GdalErrors& errors,
                 ImportedOrthomosaic& result) {
  const std::vector<int> bands = colour_bands(dataset, path);
  result.map.image = Raster<std::uint8_t>(dataset.GetRasterXSize(), dataset.GetRasterYSize(), 0,
                                          static_cast<int>(bands.size()));
  result.map.valid = read_validity(dataset, bands, path, errors);
  if (!is_8_bit(dataset, bands)) {
    read_stretched(dataset, bands, path, errors, result);
    return;
  }
  for (std::size_t i = 0; i < bands.size(); ++i) {
    read_band(*dataset.GetRasterBand(bands[i]), result.map.image, static_cast<int>(i), path,
              errors);
  }
}

/// Pixels of the collar's colour that are joined to the border of the image become holes.
void remove_collar(Collar collar, ImportedOrthomosaic& result) {
  if (collar == Collar::kNone) return;
  Orthomosaic& map = result.map;
  cv::Mat alike(map.height(), map.width(), CV_8UC1);
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      bool like = true;
      for (int channel = 0; channel < map.image.channels(); ++channel) {
        const int value = map.image.at(column, row, channel);
        like = like && (collar == Collar::kWhite ? value >= 255 - kCollarTolerance
                                                 : value <= kCollarTolerance);
      }
      alike.at<std::uint8_t>(row, column) = like || map.valid.at(column, row) == 0 ? 255 : 0;
    }
  }
  cv::Mat labels;
  const int count = cv::connectedComponents(alike, labels, 4, CV_32S);
  std::vector<char> border(static_cast<std::size_t>(count), 0);
  const auto mark = [&](int row, int column) {
    border[static_cast<std::size_t>(labels.at<int>(row, column))] = 1;
  };
  for (int column = 0; column < map.width(); ++column)
    mark(0, column), mark(labels.rows - 1, column);
  for (int row = 0; row < map.height(); ++row) mark(row, 0), mark(row, labels.cols - 1);
  border[0] = 0;  // what is not like the collar
  int removed = 0;
  for (int row = 0; row < map.height(); ++row) {
    for (int column = 0; column < map.width(); ++column) {
      if (border[static_cast<std::size_t>(labels.at<int>(row, column))] == 0) continue;
      if (map.valid.at(column, row) != 0) ++removed;
      map.valid.at(column, row) = 0;
    }
  }
  result.notes.push_back(fmt::format("{} pixels of the {} collar are holes now", removed,
                                     collar == Collar::kWhite ? "white" : "black"));
}

void set_crs(const std::string& text, const Path& path, GeoReference& geo) {
  OGRSpatialReference crs;
  if (!set_reference_system(text, crs)) {
    throw Error(ErrorKind::kUsage, "'" + text + "' is no reference system", "--crs",
                "write EPSG:code");
  }
  if (crs.IsProjected() == 0) {
    throw Error(ErrorKind::kUsage, "a map in metres cannot be in " + text, path.string(),
                "give a projected one, as EPSG:326NN");
  }
  char* wkt = nullptr;
  crs.exportToWkt(&wkt);
  geo.crs = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
}

GeoReference plain_reference(const ImportOptions& options, const Path& path, int height) {
  const auto scale = given_scale(options);
  if (!scale) {
    throw input_error(path, "it has neither a geotransform nor a world file beside it",
                      "give --metres-per-pixel, or --points X1,Y1,X2,Y2 with --distance METRES");
  }
  if (!(*scale > 0.0)) {
    throw Error(ErrorKind::kUsage, "metres per pixel must be above 0", "--metres-per-pixel");
  }
  return {0.0, height * *scale, *scale, {}};
}

/// Plain images are reduced by area here: GDAL would not warp what has no geo-reference.
void resample_plain(double resolution, const ImportOptions& options, const Path& path,
                    ImportedOrthomosaic& result) {
  Orthomosaic& map = result.map;
  const double factor = map.geo.resolution / resolution;
  check_result_size(map.width() * factor, map.height() * factor, options, path);
  const int width = std::max(1, static_cast<int>(std::lround(map.width() * factor)));
  const int height = std::max(1, static_cast<int>(std::lround(map.height() * factor)));
  const int method = factor < 1.0 ? cv::INTER_AREA : cv::INTER_CUBIC;
  const auto resize = [&](Raster<std::uint8_t>& raster, int how) {
    Raster<std::uint8_t> into(width, height, 0, raster.channels());
    const cv::Mat from(raster.height(), raster.width(), CV_8UC(raster.channels()),
                       raster.values().data());
    cv::Mat to(height, width, CV_8UC(raster.channels()), into.values().data());
    cv::resize(from, to, to.size(), 0.0, 0.0, how);
    raster = std::move(into);
  };
  resize(map.image, method);
  resize(map.valid, cv::INTER_NEAREST);
  result.notes.push_back(
      fmt::format("resampled from {:.4g} m to {:.4g} m a pixel", map.geo.resolution, resolution));
  map.geo.resolution = resolution;
  map.geo.north = height * resolution;
}

void check_valid(const ImportedOrthomosaic& result, const Path& path) {
  const auto& valid = result.map.valid.values();
  if (std::any_of(valid.begin(), valid.end(), [](std::uint8_t seen) { return seen != 0; })) return;
  throw input_error(path, "every pixel of it is a hole (alpha, mask or nodata)",
                    "check it with gdalinfo; `gdal_edit.py -unsetnodata` removes a wrong nodata");
}

}  // namespace

ImportedOrthomosaic import_orthomosaic(const Path& path, const ImportOptions& options) {
  check_orthomosaic_file(path);
  const GdalErrors errors;
  const GdalSetting strict("GDAL_ERROR_ON_LIBJPEG_WARNING", "YES");
  ImportedOrthomosaic result;
  GdalDataset dataset = open_raster(path, errors);
  check_raster_size(*dataset, path);
  if (dataset->GetRasterBand(1)->GetColorTable() != nullptr) {
    dataset = expanded_palette(*dataset, path);
    result.notes.emplace_back("its palette became red, green and blue");
  }
  colour_bands(*dataset, path);  // CMYK and the like end here
  if (GdalDataset warped = warped_to_metric(*dataset, path, options, result.notes)) {
    dataset = std::move(warped);
  }
  read_pixels(*dataset, path, errors, result);
  if (const auto geo = read_geo_reference(*dataset, path)) {
    result.map.geo = *geo;
  } else {
    result.map.geo = plain_reference(options, path, dataset->GetRasterYSize());
    if (options.resolution_m) resample_plain(*options.resolution_m, options, path, result);
  }
  if (!options.crs.empty() && result.map.geo.crs.empty()) {
    set_crs(options.crs, path, result.map.geo);
  }
  if (result.map.geo.crs.empty()) {
    result.notes.emplace_back(
        "no reference system: the map is in local metres (--crs EPSG:code gives one)");
  }
  remove_collar(options.collar, result);
  check_valid(result, path);
  return result;
}

}  // namespace nadir
