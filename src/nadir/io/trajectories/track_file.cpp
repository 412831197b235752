// SPDX-License-Identifier: Apache-2.0
#include "nadir/io/trajectories/track_file.hpp"

#include <cpl_string.h>
#include <ogr_spatialref.h>
#include <ogrsf_frmts.h>

#include <cmath>
#include <vector>

#include "nadir/core/angle.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/detail/gdal_support.hpp"
#include "nadir/io/detail/reference_system.hpp"

namespace nadir {
namespace {

struct GeographicPose {
  double longitude_deg = 0.0;
  double latitude_deg = 0.0;
  double heading_deg = 0.0;  ///< clockwise from true north
};

OGRSpatialReference wgs84() {
  OGRSpatialReference crs;
  crs.SetWellKnownGeogCS("WGS84");
  crs.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  return crs;
}

/// The heading is that of a step of a metre, so that the grid convergence is in it.
std::vector<GeographicPose> geographic(const Trajectory& trajectory, const std::string& crs,
                                       const std::filesystem::path& path) {
  OGRSpatialReference map;
  if (!set_reference_system(crs, map)) {
    throw Error(ErrorKind::kUsage, "the map has no reference system: it lies nowhere on the Earth",
                path.string());
  }
  map.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
  const OGRSpatialReference earth = wgs84();
  const std::unique_ptr<OGRCoordinateTransformation> to_earth(
      OGRCreateCoordinateTransformation(&map, &earth));
  std::vector<GeographicPose> poses;
  for (const auto& stamped : trajectory) {
    double x[2] = {stamped.pose.x, stamped.pose.x + std::cos(stamped.pose.yaw)};
    double y[2] = {stamped.pose.y, stamped.pose.y + std::sin(stamped.pose.yaw)};
    if (!to_earth || to_earth->Transform(2, x, y) == 0) {
      throw Error(ErrorKind::kProcessing, "a pose lies outside of the map's reference system",
                  path.string());
    }
    const double east = (x[1] - x[0]) * std::cos(radians(y[0]));
    double heading = degrees(std::atan2(east, y[1] - y[0]));
    if (heading < 0.0) heading += 360.0;
    poses.push_back({x[0], y[0], heading});
  }
  return poses;
}

void add_field(OGRLayer& layer, const char* name, OGRFieldType type) {
  OGRFieldDefn field(name, type);
  layer.CreateField(&field);
}

bool add_line(OGRLayer& layer, const std::vector<GeographicPose>& poses, const std::string& name) {
  OGRLineString line;
  for (const GeographicPose& pose : poses) line.addPoint(pose.longitude_deg, pose.latitude_deg);
  OGRFeature feature(layer.GetLayerDefn());
  feature.SetField("name", name.c_str());
  feature.SetGeometry(&line);
  return layer.CreateFeature(&feature) == OGRERR_NONE;
}

bool add_points(OGRLayer& layer, const std::vector<GeographicPose>& poses,
                const Trajectory& trajectory) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    OGRPoint point(poses[i].longitude_deg, poses[i].latitude_deg);
    OGRFeature feature(layer.GetLayerDefn());
    feature.SetField("name", to_string(trajectory[i].stamp).c_str());
    feature.SetField("stamp_s", to_string(trajectory[i].stamp).c_str());
    feature.SetField("heading_deg", poses[i].heading_deg);
    feature.SetField("map_x", trajectory[i].pose.x);
    feature.SetField("map_y", trajectory[i].pose.y);
    feature.SetGeometry(&point);
    if (layer.CreateFeature(&feature) != OGRERR_NONE) return false;
  }
  return true;
}

}  // namespace

void write_track(const std::filesystem::path& path, const Trajectory& trajectory,
                 const std::string& crs, const std::string& name) {
  const bool kml = path.extension() == ".kml";
  if (!kml && path.extension() != ".geojson") {
    throw Error(ErrorKind::kUsage, "'" + path.extension().string() + "' is no format for a track",
                path.string(), "write .geojson or .kml");
  }
  GDALDriver& driver = gdal_driver(kml ? "KML" : "GeoJSON");
  const GdalErrors errors;
  const std::vector<GeographicPose> poses = geographic(trajectory, crs, path);
  AtomicFile file(path);
  GdalDataset dataset(driver.Create(file.temporary().c_str(), 0, 0, 0, GDT_Unknown, nullptr));
  CPLStringList options;
  if (!kml) {
    options.SetNameValue("RFC7946", "YES");
    options.SetNameValue("COORDINATE_PRECISION", "9");
  }
  OGRSpatialReference earth = wgs84();
  OGRLayer* layer = dataset == nullptr
                        ? nullptr
                        : dataset->CreateLayer("track", &earth, wkbUnknown, options.List());
  bool written = layer != nullptr;
  if (written) {
    add_field(*layer, "name", OFTString);
    add_field(*layer, "stamp_s", OFTString);
    add_field(*layer, "heading_deg", OFTReal);
    add_field(*layer, "map_x", OFTReal);
    add_field(*layer, "map_y", OFTReal);
    written = add_line(*layer, poses, name) && add_points(*layer, poses, trajectory);
  }
  dataset.reset();  // the file is finished when it closes
  if (!written || errors.failed()) {
    throw Error(ErrorKind::kProcessing, "cannot be written: " + errors.first_failure(),
                path.string(), "check the folder, its permissions and the free space");
  }
  file.commit();
}

}  // namespace nadir
