// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/detail/gdal_geo_reference.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/io/detail/reference_system.hpp"
#include "nadir/io/detail/utm.hpp"
#include "nadir/io/input_file.hpp"
#include "nadir/io/shell.hpp"

namespace nadir {
namespace {

using GeoTransform = std::array<double, 6>;  ///< x = t0 + column t1 + row t2, y = t3 + ...

std::string warp_line(const std::filesystem::path& path, const std::string& arguments) {
  return fmt::format(
      "bring it in: nadir convert map {1} -o north_up.tif, or gdalwarp {0} -r cubic -dstalpha {1} "
      "north_up.tif",
      arguments, shell_quoted_path(path));
}

std::string text_of(char* allocated_by_gdal) {
  std::string text = allocated_by_gdal == nullptr ? "" : allocated_by_gdal;
  CPLFree(allocated_by_gdal);
  return text;
}

/// The UTM grid that holds a point, to be named in a remedy; a placeholder where PROJ cannot tell.
std::string utm_grid_at(const OGRSpatialReference& crs, double x, double y) {
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> to_wgs84(
      OGRCreateCoordinateTransformation(&crs, &wgs84));
  const bool placed = to_wgs84 && to_wgs84->Transform(1, &x, &y) != 0;
  const auto epsg = placed ? utm_epsg(y, x) : std::nullopt;
  if (!epsg || std::abs(x) > 180.0 || std::abs(y) > 84.0) {
    return "EPSG:326NN (NN = UTM zone)";
  }
  return fmt::format("EPSG:{}", *epsg);
}

void check_crs(const OGRSpatialReference& crs, const std::filesystem::path& path, double x,
               double y) {
  const char* method = crs.GetAttrValue("PROJECTION");
  std::string problem;
  if (crs.IsGeographic() != 0) {
    problem = "its grid is geographic (degrees), metres are needed";
  } else if (method != nullptr && std::string_view(method).starts_with("Mercator")) {
    problem = "its grid is Mercator (EPSG:3857 or alike), whose metres are stretched";
  } else if (std::abs(crs.GetLinearUnits() - 1.0) > 1e-9) {
    problem = "the unit of its grid is not the metre";
  } else {
    return;
  }
  throw input_error(path, problem, warp_line(path, "-t_srs " + utm_grid_at(crs, x, y)));
}

void check_is_finite(const GeoTransform& t, const std::filesystem::path& path) {
  if (std::ranges::all_of(t, [](double value) { return std::abs(value) <= kLargestNumber; }))
    return;
  throw input_error(path, "the numbers of its grid are not finite", "correct its world file");
}

void check_transform(const GeoTransform& t, GDALDataset& dataset,
                     const std::filesystem::path& path) {
  const double size = std::max(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  // A quarter of a pixel over the whole image is rounding in the writer, not rotation.
  const double allowed = 0.25 * std::abs(t[1]) / size;
  if (std::abs(t[2]) > allowed || std::abs(t[4]) > allowed || t[1] <= 0.0 || t[5] >= 0.0) {
    throw input_error(path, "its grid is rotated or flipped, rows must run south and columns east",
                      warp_line(path, ""));
  }
  if (std::abs(t[1] + t[5]) > allowed) {
    throw input_error(path,
                      fmt::format("its pixels are not square ({:.9g} x {:.9g} m)", t[1], -t[5]),
                      warp_line(path, fmt::format("-tr {0:.9g} {0:.9g}", std::max(t[1], -t[5]))));
  }
}

/// The reference system in the file or in a .prj beside it; nothing where there is neither.
std::optional<OGRSpatialReference> read_crs(GDALDataset& dataset,
                                            const std::filesystem::path& path) {
  if (const OGRSpatialReference* own = dataset.GetSpatialRef(); own != nullptr) return *own;
  std::filesystem::path beside = path;
  beside.replace_extension(".prj");
  if (!is_file(beside)) return std::nullopt;
  OGRSpatialReference crs;
  if (!set_reference_system(read_file(beside), crs)) {
    throw input_error(beside, "is not a coordinate reference system in WKT",
                      "correct or remove it");
  }
  return crs;
}

}  // namespace

std::optional<GeoReference> read_geo_reference(GDALDataset& dataset,
                                               const std::filesystem::path& path) {
  GeoTransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None) {
    if (dataset.GetGCPCount() == 0) return std::nullopt;
    throw input_error(path, "it carries ground control points, but no grid", warp_line(path, ""));
  }
  check_is_finite(t, path);
  GeoReference geo{t[0], t[3], t[1], {}};
  const auto crs = read_crs(dataset, path);
  if (crs) {
    const double column = dataset.GetRasterXSize() / 2.0;
    const double row = dataset.GetRasterYSize() / 2.0;
    check_crs(*crs, path, t[0] + column * t[1] + row * t[2], t[3] + column * t[4] + row * t[5]);
    char* wkt = nullptr;
    crs->exportToWkt(&wkt);
    geo.crs = text_of(wkt);
  }
  check_transform(t, dataset, path);
  return geo;
}

}  // namespace nadir
