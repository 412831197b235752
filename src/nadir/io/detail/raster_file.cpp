// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/detail/raster_file.hpp"

#include <cpl_string.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <sstream>
#include <string>

#include "nadir/io/detail/file_pieces.hpp"
#include "nadir/io/detail/tiff_check.hpp"
#include "nadir/io/detail/vrt_check.hpp"
#include "nadir/io/image_file_check.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

using Path = std::filesystem::path;

constexpr std::size_t kHead = 1024;
constexpr std::string_view kErdasAuxiliary = "EHFA_HEADER_TAG";

/// The keys that GDAL's driver takes at the begin of an Arc/Info ASCII grid.
bool is_ascii_grid(std::string_view head) {
  const std::string begin = CPLString(std::string(head.substr(0, 16))).tolower();
  return std::ranges::any_of(std::array{"ncols", "nrows", "xllcorner", "yllcorner", "xllcenter",
                                        "yllcenter", "dx", "dy", "cellsize"},
                             [&](const char* key) { return begin.starts_with(key); });
}

/// Each value takes a digit and a separator, so that a file of text holds half as many as bytes.
void check_ascii_grid(const Path& file, std::string_view head, std::uint64_t file_size) {
  std::uint64_t columns = 0;
  std::uint64_t rows = 0;
  std::istringstream words{std::string(head)};
  for (std::string key, value; words >> key;) {
    key = CPLString(key).tolower();
    if (key != "ncols" && key != "nrows") continue;
    std::uint64_t count = 0;
    words >> value;
    const auto read = std::from_chars(value.data(), value.data() + value.size(), count);
    if (read.ec != std::errc{} || count == 0 || count > kMostRasterPixels) {
      throw input_error(file, fmt::format("its header declares '{} {}'", key, value),
                        "copy or make it again");
    }
    std::uint64_t& side = key == "ncols" ? columns : rows;
    side = std::max(side, count);
  }
  if (columns * rows > file_size / 2 + 1) {
    throw input_error(file,
                      fmt::format("its header declares {} x {} pixels, which {} bytes cannot hold",
                                  columns, rows, file_size),
                      "copy or make it again");
  }
}

void check_image(const Path& file, std::string head, std::uint64_t file_size) {
  const auto check = [&](std::string_view bytes) {
    check_image_size(file, bytes, file_size, kMostRasterPixels);
  };
  constexpr std::size_t kMetadata = std::size_t{1} << 18U;
  if (image_format(head) == ImageFormat::kPng) return check(head);
  // The size of a JPEG stands behind metadata that may be long.
  head = FilePieces(file).at(0, kMetadata);
  try {
    check(head);
  } catch (const Error&) {
    if (head.size() == file_size) throw;
    check(read_file(file));
  }
}

const char* driver_of(RasterFormat format) {
  switch (format) {
    case RasterFormat::kTiff:
      return "GTiff";
    case RasterFormat::kPng:
      return "PNG";
    case RasterFormat::kJpeg:
      return "JPEG";
    case RasterFormat::kAsciiGrid:
      return "AAIGrid";
    case RasterFormat::kVrt:
      return "VRT";
  }
  return "";
}

Error other_format(const Path& file, RasterUse use) {
  if (use == RasterUse::kPhoto) {
    return input_error(file, "is not an image that can be decoded",
                       "give JPEG, PNG or TIFF photos, or copy it again if it is damaged");
  }
  return input_error(file, "is not a raster of a format that is read",
                     fmt::format("give a GeoTIFF or COG, PNG, JPEG, Arc/Info ASCII grid or VRT; "
                                 "others become one by: gdal_translate {} out.tif",
                                 shell_quoted_path(file)));
}

void check_header(const Path& file, RasterFormat format, const std::string& head,
                  FilePieces& pieces) {
  switch (format) {
    case RasterFormat::kTiff:
      return check_tiff(
          file, [&](std::uint64_t at, std::size_t count) { return pieces.at(at, count); },
          pieces.size());
    case RasterFormat::kPng:
    case RasterFormat::kJpeg:
      return check_image(file, head, pieces.size());
    case RasterFormat::kAsciiGrid:
      return check_ascii_grid(file, head, pieces.size());
    case RasterFormat::kVrt:
      return;  // its text is looked at with what it names
  }
}

GdalDataset open_checked(const Path& file, const GdalErrors& errors, RasterUse use, bool vrt);

/// GDAL looks for overviews and masks beside a raster, and opens what it finds by any driver.
void check_beside(const Path& file, const GdalErrors& errors, RasterUse use) {
  for (const char* extension : {".ovr", ".msk"}) {
    if (lower_extension(file) == extension) continue;
    Path beside = file;
    beside += extension;
    if (is_file(beside)) open_checked(beside, errors, use, false);
  }
  Path added = file;
  added += ".aux";
  Path replaced = file;
  replaced.replace_extension(".aux");
  for (const Path& beside : {added, replaced}) {
    if (!is_file(beside)) continue;
    if (FilePieces(beside).at(0, kErdasAuxiliary.size()) != kErdasAuxiliary) continue;
    throw input_error(beside, "is an auxiliary file of Erdas Imagine, which is not read",
                      "remove it, or let GDAL take it up: gdal_translate " +
                          shell_quoted_path(file) + " out.tif");
  }
}

/// A name that GDAL's drivers cannot take for a notation of theirs ("GTIFF_DIR:2:map.tif").
std::string plain_name(const Path& file) {
  return file.is_absolute() ? file.string() : "./" + file.string();
}

GdalDataset open_checked(const Path& file, const GdalErrors& errors, RasterUse use, bool vrt) {
  check_input_file(file);
  FilePieces pieces(file);
  const std::string head = pieces.at(0, kHead);
  const auto format = raster_format(head);
  const bool grid = format == RasterFormat::kAsciiGrid || format == RasterFormat::kVrt;
  if (!format || (grid && use == RasterUse::kPhoto)) throw other_format(file, use);
  check_header(file, *format, head, pieces);
  if (format == RasterFormat::kVrt) {
    if (!vrt) throw input_error(file, "is another VRT inside of one", "name its files directly");
    for (const Path& source : vrt_sources(file)) open_checked(source, errors, use, false);
  }
  check_beside(file, errors, use);
  gdal_driver(driver_of(*format));
  const std::array<const char*, 2> drivers{driver_of(*format), nullptr};
  GdalDataset dataset(GDALDataset::Open(plain_name(file).c_str(), GDAL_OF_RASTER | GDAL_OF_READONLY,
                                        drivers.data()));
  if (!dataset || dataset->GetRasterCount() == 0) {
    if (use == RasterUse::kPhoto) throw other_format(file, use);
    throw input_error(file,
                      "is not a raster that GDAL can open" +
                          (errors.failed() ? " (" + errors.first_failure() + ")" : ""),
                      "copy or make it again, it is cut off or damaged");
  }
  if (dataset->GetMetadataItem("OVERVIEW_FILE", "OVERVIEWS") != nullptr) {
    throw input_error(file, "it names another file for its overviews, which is not read",
                      "write it as a file of its own: gdal_translate -nomd " +
                          shell_quoted_path(file) + " out.tif");
  }
  return dataset;
}

}  // namespace

std::optional<RasterFormat> raster_format(std::string_view head) {
  switch (image_format(head).value_or(ImageFormat::kPnm)) {
    case ImageFormat::kPng:
      return RasterFormat::kPng;
    case ImageFormat::kJpeg:
      return RasterFormat::kJpeg;
    case ImageFormat::kTiff:
      return RasterFormat::kTiff;
    case ImageFormat::kPnm:
      break;  // has no place for a geo-reference
  }
  if (is_ascii_grid(head)) return RasterFormat::kAsciiGrid;
  const std::size_t begin = head.find_first_not_of(" \t\r\n");
  const bool xml = begin != std::string_view::npos && head[begin] == '<';
  if (xml && head.find("<VRTDataset") != std::string_view::npos) return RasterFormat::kVrt;
  return std::nullopt;
}

GdalDataset open_raster(const Path& file, const GdalErrors& errors, RasterUse use) {
  if (file.string().starts_with("/vsi")) {
    throw input_error(file, "names one of GDAL's virtual file systems; local files are read",
                      "fetch it: gdal_translate " + shell_quoted_path(file) + " out.tif");
  }
  return open_checked(file, errors, use, true);
}

}  // namespace nadir
