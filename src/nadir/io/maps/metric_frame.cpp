// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/maps/metric_frame.hpp"

#include <fmt/format.h>
#include <ogr_spatialref.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/detail/reference_system.hpp"
#include "nadir/io/detail/utm.hpp"

namespace nadir {
namespace {

using Transformation = std::unique_ptr<OGRCoordinateTransformation>;

OGRSpatialReference from_epsg(int code) {
  OGRSpatialReference crs;
  crs.importFromEPSG(code);
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

Transformation transformation(const OGRSpatialReference& from, const OGRSpatialReference& to) {
  Transformation result(OGRCreateCoordinateTransformation(&from, &to));
  if (!result) {
    throw Error(ErrorKind::kProcessing, "PROJ cannot transform between two reference systems", {},
                "check the installation of PROJ (`nadir doctor`)");
  }
  return result;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Longitudes on both sides of the antimeridian are one neighbourhood.
double median_longitude(std::vector<double> longitudes) {
  const auto [west, east] = std::minmax_element(longitudes.begin(), longitudes.end());
  if (*east - *west > 180.0) {
    for (double& longitude : longitudes) {
      if (longitude < 0.0) longitude += 360.0;
    }
  }
  return std::remainder(median(std::move(longitudes)), 360.0);
}

}  // namespace

struct MetricFrame::Transforms {
  Transformation to_grid;
  Transformation to_geodetic;
};

MetricFrame::MetricFrame(MetricFrame&&) noexcept = default;
MetricFrame& MetricFrame::operator=(MetricFrame&&) noexcept = default;
MetricFrame::~MetricFrame() = default;

MetricFrame::MetricFrame(int epsg, std::string name)
    : name_(std::move(name)), transforms_(std::make_unique<Transforms>()) {
  const GdalErrors errors;
  const OGRSpatialReference grid = from_epsg(epsg);
  const OGRSpatialReference wgs84 = from_epsg(4326);
  transforms_->to_grid = transformation(wgs84, grid);
  transforms_->to_geodetic = transformation(grid, wgs84);
  char* wkt = nullptr;
  grid.exportToWkt(&wkt);
  crs_ = wkt == nullptr ? "" : wkt;
  CPLFree(wkt);
}

MetricFrame MetricFrame::around(const std::vector<GeodeticPosition>& positions) {
  if (positions.empty()) {
    throw Error(ErrorKind::kUsage, "there are no positions to choose a map frame from");
  }
  std::vector<double> latitudes, longitudes;
  for (const GeodeticPosition& position : positions) {
    latitudes.push_back(position.latitude_deg);
    longitudes.push_back(position.longitude_deg);
  }
  GeodeticPosition middle;
  middle.latitude_deg = median(std::move(latitudes));
  middle.longitude_deg = median_longitude(std::move(longitudes));
  const auto epsg = utm_epsg(middle.latitude_deg, middle.longitude_deg);
  if (!epsg || middle.latitude_deg > 84.0 || middle.latitude_deg < -80.0) {
    throw Error(ErrorKind::kUsage,
                fmt::format("the photos lie at latitude {:.3f}, where UTM has no zone",
                            middle.latitude_deg),
                {}, "remove the positions and give --metres-per-pixel for a map in local metres");
  }
  return {*epsg, fmt::format("EPSG:{} (UTM zone {} {})", *epsg, *epsg % 100,
                             middle.latitude_deg < 0.0 ? "south" : "north")};
}

Point3<frames::Map> MetricFrame::to_map(const GeodeticPosition& position) const {
  const GdalErrors errors;
  double x = position.longitude_deg;
  double y = position.latitude_deg;
  if (transforms_->to_grid->Transform(1, &x, &y) == 0 || !std::isfinite(x + y)) {
    throw Error(ErrorKind::kInput,
                fmt::format("the position {:.6f}, {:.6f} lies outside of {}", position.latitude_deg,
                            position.longitude_deg, name_),
                {}, "correct it or leave the photo out");
  }
  return {x, y, position.altitude_m};
}

GeodeticPosition MetricFrame::to_geodetic(const Point3<frames::Map>& point) const {
  const GdalErrors errors;
  double x = point.x;
  double y = point.y;
  transforms_->to_geodetic->Transform(1, &x, &y);
  GeodeticPosition position;
  position.latitude_deg = y;
  position.longitude_deg = x;
  position.altitude_m = point.z;
  return position;
}

double MetricFrame::yaw_of_true_heading(double heading_rad, const GeodeticPosition& place) const {
  GeodeticPosition north = place;
  north.latitude_deg += 1e-4;  // 11 m
  const Eigen::Vector3d step = to_map(north).vector() - to_map(place).vector();
  const double grid_heading_of_north = std::atan2(step.x(), step.y());
  return yaw_of_heading(heading_rad + grid_heading_of_north);
}

std::optional<int> utm_zone_at(const std::string& crs, double x, double y) {
  const GdalErrors errors;
  OGRSpatialReference grid;
  if (!set_reference_system(crs, grid)) return std::nullopt;
  grid.StripVertical();
  grid.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  int is_north = 0;
  const int zone = grid.GetUTMZone(&is_north);
  if (zone == 0) return std::nullopt;
  const int epsg = (is_north != 0 ? 32600 : 32700) + zone;
  const OGRSpatialReference known = from_epsg(epsg);
  if (grid.IsSame(&known) == 0) return std::nullopt;
  double longitude = x;
  double latitude = y;
  const Transformation to_geodetic = transformation(known, from_epsg(4326));
  if (to_geodetic->Transform(1, &longitude, &latitude) == 0) return std::nullopt;
  if (utm_epsg(latitude, longitude) != epsg) return std::nullopt;
  return is_north != 0 ? zone : -zone;
}

namespace {

/// "EPSG:32632" for ODM's own notation, "WGS84 UTM 32N".
std::optional<std::string> epsg_of_odm(const std::string& text) {
  int zone = 0;
  int read = 0;
  char side = 'N';
  if (std::sscanf(text.c_str(), "WGS84 UTM %2d%c%n", &zone, &side, &read) != 2 ||
      static_cast<std::size_t>(read) != text.size() || zone < 1 || zone > 60) {
    return std::nullopt;
  }
  return fmt::format("EPSG:{}", (side == 'S' || side == 's' ? 32700 : 32600) + zone);
}

}  // namespace

struct GeodeticReader::Transform {
  Transformation to_geodetic;
};

GeodeticReader::GeodeticReader(const std::string& reference_system, const std::string& where)
    : transform_(std::make_unique<Transform>()) {
  const GdalErrors errors;
  OGRSpatialReference crs;
  const std::string text = epsg_of_odm(reference_system).value_or(reference_system);
  if (!set_reference_system(text, crs)) {
    throw Error(ErrorKind::kInput, "'" + reference_system + "' is no reference system", where,
                "write EPSG:code, a PROJ string or WGS84 UTM 32N");
  }
  transform_->to_geodetic = transformation(crs, from_epsg(4326));
}

GeodeticReader::~GeodeticReader() = default;

GeodeticPosition GeodeticReader::read(double x, double y, double z,
                                      const std::string& where) const {
  const GdalErrors errors;
  double longitude = x;
  double latitude = y;
  const bool done = transform_->to_geodetic->Transform(1, &longitude, &latitude) != 0;
  if (!done || !std::isfinite(longitude + latitude) || std::abs(latitude) > 90.0 ||
      std::abs(longitude) > 180.0 + 1e-9) {
    throw Error(ErrorKind::kInput,
                fmt::format("{:.9g}, {:.9g} lies outside of the file's reference system", x, y),
                where, "check the reference system in the first line and the order east, north");
  }
  GeodeticPosition position;
  position.latitude_deg = latitude;
  position.longitude_deg = longitude;
  position.altitude_m = z;
  return position;
}

Eigen::Vector3d geocentric(const GeodeticPosition& position) {
  const GdalErrors errors;
  double x = position.longitude_deg;
  double y = position.latitude_deg;
  double z = position.altitude_m;
  transformation(from_epsg(4979), from_epsg(4978))->Transform(1, &x, &y, &z);
  return {x, y, z};
}

GeodeticPosition from_geocentric(const Eigen::Vector3d& point) {
  const GdalErrors errors;
  double x = point.x();
  double y = point.y();
  double z = point.z();
  transformation(from_epsg(4978), from_epsg(4979))->Transform(1, &x, &y, &z);
  GeodeticPosition position;
  position.latitude_deg = y;
  position.longitude_deg = x;
  position.altitude_m = z;
  position.ellipsoidal = true;
  return position;
}

Eigen::Matrix3d geocentric_from_enu(const GeodeticPosition& place) {
  const double phi = radians(place.latitude_deg);
  const double lambda = radians(place.longitude_deg);
  Eigen::Matrix3d axes;
  axes.col(0) << -std::sin(lambda), std::cos(lambda), 0.0;
  axes.col(1) << -std::sin(phi) * std::cos(lambda), -std::sin(phi) * std::sin(lambda),
      std::cos(phi);
  axes.col(2) << std::cos(phi) * std::cos(lambda), std::cos(phi) * std::sin(lambda), std::sin(phi);
  return axes;
}

}  // namespace nadir
