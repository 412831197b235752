// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/detail/gdal_warp.hpp"

#include <cpl_string.h>
#include <fmt/format.h>
#include <gdal_alg.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "nadir/io/detail/reference_system.hpp"
#include "nadir/io/detail/utm.hpp"
#include "nadir/io/input_file.hpp"

namespace nadir {
namespace {

using GeoTransform = std::array<double, 6>;  ///< x = t0 + column t1 + row t2, y = t3 + ...

struct WarpPlan {
  std::string target;            ///< "EPSG:326NN"; empty = the reference system stays
  std::vector<std::string> why;  ///< empty = nothing to be done
};

std::string name_of(const OGRSpatialReference& crs) {
  const char* name = crs.GetName();
  return name == nullptr ? "its own reference system" : name;
}

/// The UTM zone at the centre of the image.
std::string utm_zone(const OGRSpatialReference& crs, const GeoTransform& t, GDALDataset& dataset,
                     const std::filesystem::path& path) {
  double x = t[0] + 0.5 * (t[1] * dataset.GetRasterXSize() + t[2] * dataset.GetRasterYSize());
  double y = t[3] + 0.5 * (t[4] * dataset.GetRasterXSize() + t[5] * dataset.GetRasterYSize());
  OGRSpatialReference from = crs;
  from.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  OGRSpatialReference wgs84;
  wgs84.SetWellKnownGeogCS("WGS84");
  wgs84.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const std::unique_ptr<OGRCoordinateTransformation> transformation(
      OGRCreateCoordinateTransformation(&from, &wgs84));
  const bool placed = transformation && transformation->Transform(1, &x, &y) != 0;
  const auto epsg = placed ? utm_epsg(y, x) : std::nullopt;
  if (!epsg || std::abs(x) > 180.0 || y > 84.0 || y < -80.0) {
    throw input_error(path, "its centre lies where UTM has no zone",
                      "check its reference system, or warp it with gdalwarp to a metric one");
  }
  return fmt::format("EPSG:{}", *epsg);
}

void plan_crs(const OGRSpatialReference& crs, const GeoTransform& t, GDALDataset& dataset,
              const std::filesystem::path& path, WarpPlan& plan) {
  const char* method = crs.GetAttrValue("PROJECTION");
  const bool mercator = method != nullptr && std::string(method).starts_with("Mercator");
  const bool metric = crs.IsProjected() != 0 && std::abs(crs.GetLinearUnits() - 1.0) < 1e-9;
  if (metric && !mercator) return;
  plan.target = utm_zone(crs, t, dataset, path);
  const char* problem = crs.IsGeographic() != 0 ? "degrees"
                        : mercator              ? "stretched metres (Mercator)"
                                                : "no metres";
  plan.why.push_back(fmt::format("warped from {} ({}) to {}", name_of(crs), problem, plan.target));
}

void plan_transform(const GeoTransform& t, GDALDataset& dataset, WarpPlan& plan) {
  const double size = std::max(dataset.GetRasterXSize(), dataset.GetRasterYSize());
  const double allowed = 0.25 * std::abs(t[1]) / size;
  if (std::abs(t[2]) > allowed || std::abs(t[4]) > allowed) {
    plan.why.push_back(fmt::format("its grid was turned by {:.2f} degrees; warped to north-up",
                                   std::atan2(t[4], t[1]) * 180.0 / M_PI));
  } else if (t[1] <= 0.0 || t[5] >= 0.0) {
    plan.why.emplace_back("its grid was flipped; warped to north-up");
  } else if (std::abs(t[1] + t[5]) > allowed) {
    plan.why.push_back(
        fmt::format("its pixels were {:.9g} x {:.9g}; warped to squares", t[1], -t[5]));
  }
}

/// The pixel size that keeps the detail of the file, and the extent in pixels of that size.
GeoTransform suggested_grid(GDALDataset& dataset, const std::string& target,
                            const std::filesystem::path& path, int& width, int& height) {
  CPLStringList options;
  if (!target.empty()) options.SetNameValue("DST_SRS", target.c_str());
  void* transformer = GDALCreateGenImgProjTransformer2(&dataset, nullptr, options.List());
  GeoTransform grid{};
  const bool done = transformer != nullptr &&
                    GDALSuggestedWarpOutput(&dataset, GDALGenImgProjTransform, transformer,
                                            grid.data(), &width, &height) == CE_None;
  if (transformer != nullptr) GDALDestroyGenImgProjTransformer(transformer);
  if (!done) {
    throw input_error(path, "cannot be warped to a metric grid",
                      "check its reference system with gdalinfo");
  }
  return grid;
}

GdalDataset warp(GDALDataset& dataset, const std::filesystem::path& path, const std::string& crs,
                 const std::string& target, double resolution, const char* method) {
  CPLStringList arguments;
  const std::string size = fmt::format("{:.12g}", resolution);
  for (const char* word : {"-of", "MEM", "-r", method, "-tr", size.c_str(), size.c_str(), "-tap",
                           "-dstalpha", "-wo", "UNIFIED_SRC_NODATA=YES"}) {
    arguments.AddString(word);
  }
  if (!crs.empty()) {
    arguments.AddString("-s_srs");
    arguments.AddString(crs.c_str());
  }
  if (!target.empty()) {
    arguments.AddString("-t_srs");
    arguments.AddString(target.c_str());
  }
  const GdalErrors errors;
  GDALWarpAppOptions* options = GDALWarpAppOptionsNew(arguments.List(), nullptr);
  std::array<GDALDatasetH, 1> sources{&dataset};
  int misused = 0;
  GdalDataset result(
      static_cast<GDALDataset*>(GDALWarp("", nullptr, 1, sources.data(), options, &misused)));
  GDALWarpAppOptionsFree(options);
  if (!result || errors.failed()) {
    throw input_error(path, "cannot be warped: " + errors.first_failure(),
                      "check it with gdalinfo");
  }
  return result;
}

void note_resolution(double before, double after, std::vector<std::string>& notes) {
  constexpr double kWorthSaying = 1.5;
  if (after > kWorthSaying * before) {
    notes.push_back(fmt::format("averaged from {:.4g} m to {:.4g} m a pixel", before, after));
  } else if (before > kWorthSaying * after) {
    notes.push_back(fmt::format(
        "its pixels are {:.4g} m: at {:.4g} m the map shows no more than before", before, after));
  }
}

}  // namespace

void check_result_size(double width, double height, const ImportOptions& options,
                       const std::filesystem::path& path) {
  const double megapixels = width * height / 1e6;
  if (megapixels <= options.most_megapixels) return;  // a NaN is not
  throw input_error(path, fmt::format("the map would have {:.0f} million pixels", megapixels),
                    "give a coarser --gsd, or check its reference system with gdalinfo");
}

GdalDataset warped_to_metric(GDALDataset& dataset, const std::filesystem::path& path,
                             const ImportOptions& options, std::vector<std::string>& notes) {
  const std::string& crs = options.crs;
  GeoTransform t{};
  if (dataset.GetGeoTransform(t.data()) != CE_None) return nullptr;
  OGRSpatialReference reference;
  if (!crs.empty()) {
    if (!set_reference_system(crs, reference)) {
      throw Error(ErrorKind::kUsage, "'" + crs + "' is no reference system", "--crs",
                  "write EPSG:code");
    }
  } else if (const OGRSpatialReference* own = dataset.GetSpatialRef(); own != nullptr) {
    reference = *own;
  }
  WarpPlan plan;
  if (!reference.IsEmpty()) plan_crs(reference, t, dataset, path, plan);
  if (plan.target.empty()) plan_transform(t, dataset, plan);
  double before = std::sqrt(std::abs(t[1] * t[5] - t[2] * t[4]));
  int width = dataset.GetRasterXSize();
  int height = dataset.GetRasterYSize();
  if (!plan.why.empty()) {
    before = suggested_grid(dataset, plan.target, path, width, height)[1];
  }
  const double after = options.resolution_m.value_or(before);
  if (plan.why.empty() && std::abs(after - before) < 1e-9 * before) return nullptr;
  check_result_size(width * (before / after), height * (before / after), options, path);
  constexpr double kAverageFrom = 1.2;  // coarser than this, interpolation would alias
  GdalDataset result = warp(dataset, path, crs, plan.target, after,
                            after > kAverageFrom * before ? "average" : "cubic");
  notes.insert(notes.end(), plan.why.begin(), plan.why.end());
  note_resolution(before, after, notes);
  return result;
}

GdalDataset expanded_palette(GDALDataset& dataset, const std::filesystem::path& path) {
  CPLStringList arguments;
  for (const char* word : {"-of", "MEM", "-expand", "rgb"}) arguments.AddString(word);
  const GdalErrors errors;
  GDALTranslateOptions* options = GDALTranslateOptionsNew(arguments.List(), nullptr);
  int misused = 0;
  GdalDataset result(static_cast<GDALDataset*>(GDALTranslate("", &dataset, options, &misused)));
  GDALTranslateOptionsFree(options);
  if (!result || errors.failed()) {
    throw input_error(path, "its palette cannot be read: " + errors.first_failure());
  }
  return result;
}

}  // namespace nadir
