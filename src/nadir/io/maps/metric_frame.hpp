// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/frames3.hpp"
#include "nadir/core/photo.hpp"

namespace nadir {

/// A metric map frame on the Earth: one UTM zone. x = grid east, y = grid north, z = the altitude
/// as it was given.
class MetricFrame {
 public:
  /// The UTM zone (EPSG:326NN, 327NN) of the median position. One zone holds for all positions, on
  /// whichever side of its border they lie. Throws Error (usage) for no positions, and beyond 84
  /// degrees north or 80 south, where UTM ends.
  static MetricFrame around(const std::vector<GeodeticPosition>& positions);

  MetricFrame(MetricFrame&&) noexcept;
  MetricFrame& operator=(MetricFrame&&) noexcept;
  MetricFrame(const MetricFrame&) = delete;
  MetricFrame& operator=(const MetricFrame&) = delete;
  ~MetricFrame();

  const std::string& crs() const { return crs_; }    ///< WKT
  const std::string& name() const { return name_; }  ///< "EPSG:32615 (UTM zone 15 north)"

  Point3<frames::Map> to_map(const GeodeticPosition& position) const;
  GeodeticPosition to_geodetic(const Point3<frames::Map>& point) const;

  /// Yaw in the frame of a heading from true north (clockwise), both radians: the grid convergence
  /// at the place is taken off, which is up to 3 degrees at the border of a zone.
  double yaw_of_true_heading(double heading_rad, const GeodeticPosition& place) const;

 private:
  struct Transforms;
  MetricFrame(int epsg, std::string name);

  std::string crs_;
  std::string name_;
  std::unique_ptr<Transforms> transforms_;
};

/// The UTM zone whose grid a reference system is, from its WKT, and in which MetricFrame puts this
/// place on it too: 1 .. 60, negative south of the equator. None for every other system, one of the
/// same zone on another datum included, and for places of another zone.
std::optional<int> utm_zone_at(const std::string& crs, double x, double y);

/// Coordinates of a reference system, as "EPSG:32632", a PROJ string, WKT, or ODM's "WGS84 UTM
/// 32N"; geographic ones take x = longitude, y = latitude, degrees. The altitude is handed on as it
/// is. Throws Error (input), that names `where`, for a system that is not understood and a point
/// outside of it.
class GeodeticReader {
 public:
  GeodeticReader(const std::string& reference_system, const std::string& where);
  GeodeticReader(const GeodeticReader&) = delete;
  GeodeticReader& operator=(const GeodeticReader&) = delete;
  GeodeticReader(GeodeticReader&&) = delete;
  GeodeticReader& operator=(GeodeticReader&&) = delete;
  ~GeodeticReader();

  GeodeticPosition read(double x, double y, double z, const std::string& where) const;

 private:
  struct Transform;
  std::unique_ptr<Transform> transform_;
};

/// Geocentric coordinates (x to 0 N 0 E, z to the pole, metres) of a place, and back; WGS84,
/// altitudes above the ellipsoid.
Eigen::Vector3d geocentric(const GeodeticPosition& position);
GeodeticPosition from_geocentric(const Eigen::Vector3d& point);

/// East, north and up at a place, as columns of geocentric coordinates.
Eigen::Matrix3d geocentric_from_enu(const GeodeticPosition& place);

}  // namespace nadir
