// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/gdal_info.hpp"

#include <fmt/format.h>
#include <gdal.h>
#include <ogr_spatialref.h>

#include "nadir/io/detail/gdal_support.hpp"

namespace nadir {

std::string gdal_version() { return GDALVersionInfo("RELEASE_NAME"); }

std::string proj_version() {
  int major = 0;
  int minor = 0;
  int patch = 0;
  OSRGetPROJVersion(&major, &minor, &patch);
  return fmt::format("{}.{}.{}", major, minor, patch);
}

bool has_gdal_driver(const std::string& name) {
  const GdalErrors quiet;
  GDALAllRegister();
  return GDALGetDriverByName(name.c_str()) != nullptr;
}

bool knows_epsg_codes() {
  constexpr int kUtmZone50North = 32650;
  const GdalErrors quiet;
  return OGRSpatialReference().importFromEPSG(kUtmZone50North) == OGRERR_NONE;
}

}  // namespace nadir
