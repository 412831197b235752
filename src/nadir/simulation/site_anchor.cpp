// SPDX-License-Identifier: Apache-2.0
// Transverse Mercator of WGS84, inverse, by Krueger's series to order 4 (0.01 mm within a zone).
#include <cmath>
#include <cstdlib>

#include "nadir/core/angle.hpp"
#include "nadir/simulation/simulated_world.hpp"

namespace nadir {
namespace {

constexpr double kSemiMajor = 6378137.0;
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kScale = 0.9996;
constexpr double kFalseEasting = 500000.0;
constexpr double kFalseNorthing = 1e7;  ///< south of the equator

struct Geodetic {
  double latitude = 0.0;   ///< radians
  double longitude = 0.0;  ///< from the central meridian
};

Geodetic inverse_mercator(double easting, double northing, int zone) {
  if (zone < 0) northing -= kFalseNorthing;
  const double n = kFlattening / (2.0 - kFlattening);
  const double n2 = n * n;
  const double n3 = n2 * n;
  const double n4 = n3 * n;
  const double rectifying = kSemiMajor / (1.0 + n) * (1.0 + n2 / 4.0 + n4 / 64.0);
  const double beta[] = {n / 2.0 - 2.0 * n2 / 3.0 + 37.0 * n3 / 96.0 - n4 / 360.0,
                         n2 / 48.0 + n3 / 15.0 - 437.0 * n4 / 1440.0,
                         17.0 * n3 / 480.0 - 37.0 * n4 / 840.0, 4397.0 * n4 / 161280.0};
  const double xi = northing / (kScale * rectifying);
  const double eta = (easting - kFalseEasting) / (kScale * rectifying);
  double xi_sphere = xi;
  double eta_sphere = eta;
  for (int j = 1; j <= 4; ++j) {
    xi_sphere -= beta[j - 1] * std::sin(2.0 * j * xi) * std::cosh(2.0 * j * eta);
    eta_sphere -= beta[j - 1] * std::cos(2.0 * j * xi) * std::sinh(2.0 * j * eta);
  }
  const double conformal = std::asin(std::sin(xi_sphere) / std::cosh(eta_sphere));
  const double longitude = std::atan2(std::sinh(eta_sphere), std::cos(xi_sphere));
  // Conformal to geodetic latitude: Newton on tan, as Karney (2011), equations 7 to 9.
  const double e = std::sqrt(kFlattening * (2.0 - kFlattening));
  const double wanted = std::tan(conformal);
  double tau = wanted;
  for (int i = 0; i < 6; ++i) {
    const double sigma = std::sinh(e * std::atanh(e * tau / std::hypot(1.0, tau)));
    const double here = tau * std::hypot(1.0, sigma) - sigma * std::hypot(1.0, tau);
    tau += (wanted - here) / std::hypot(1.0, here) * (1.0 + (1.0 - e * e) * tau * tau) /
           ((1.0 - e * e) * std::hypot(1.0, tau));
  }
  return {std::atan(tau), longitude};
}

}  // namespace

std::string utm_zone_32_north() {
  // EPSG:32632 as GDAL writes it.
  return R"(PROJCS["WGS 84 / UTM zone 32N",GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84)"
         R"(",6378137,298.257223563,AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIM)"
         R"(EM["Greenwich",0,AUTHORITY["EPSG","8901"]],UNIT["degree",0.0174532925199433,AUTH)"
         R"(ORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]],PROJECTION["Transverse_Mercator")"
         R"(],PARAMETER["latitude_of_origin",0],PARAMETER["central_meridian",9],PARAMETER["s)"
         R"(cale_factor",0.9996],PARAMETER["false_easting",500000],PARAMETER["false_northing)"
         R"(",0],UNIT["metre",1,AUTHORITY["EPSG","9001"]],AXIS["Easting",EAST],AXIS["Northin)"
         R"(g",NORTH],AUTHORITY["EPSG","32632"]])";
}

GeodeticPosition SiteAnchor::geodetic(const Point3<frames::Map>& point) const {
  const Geodetic place = inverse_mercator(easting_m + point.x, northing_m + point.y, utm_zone);
  const double meridian = 6.0 * std::abs(utm_zone) - 183.0;
  return {.latitude_deg = degrees(place.latitude),
          .longitude_deg = std::remainder(meridian + degrees(place.longitude), 360.0),
          .altitude_m = altitude_m + point.z,
          .ellipsoidal = true};
}

double SiteAnchor::convergence(const Point3<frames::Map>& point) const {
  constexpr double kStep = 50.0;
  const Geodetic south =
      inverse_mercator(easting_m + point.x, northing_m + point.y - kStep, utm_zone);
  const Geodetic north =
      inverse_mercator(easting_m + point.x, northing_m + point.y + kStep, utm_zone);
  const double middle = 0.5 * (south.latitude + north.latitude);
  // Isometric steps on the ellipsoid: the meridian's and the parallel's radius of curvature.
  const double e2 = kFlattening * (2.0 - kFlattening);
  const double w2 = 1.0 - e2 * std::sin(middle) * std::sin(middle);
  const double to_north = (north.latitude - south.latitude) * (1.0 - e2) / w2;
  const double to_east = (north.longitude - south.longitude) * std::cos(middle);
  return std::atan2(to_east, to_north);
}

GeoReference SiteAnchor::on_grid(const GeoReference& local) const {
  return {local.west + easting_m, local.north + northing_m, local.resolution, crs};
}

Pose2 SiteAnchor::on_grid(const Pose2& local) const {
  return {local.x + easting_m, local.y + northing_m, local.yaw};
}

}  // namespace nadir
