// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "nadir/core/frames3.hpp"
#include "nadir/core/options.hpp"
#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/photo.hpp"

namespace nadir {

namespace simulation {
struct Terrain;
class Scene;
}  // namespace simulation

enum class WorldPreset { kCampus, kParking, kFarm };

struct WorldOptions {
  WorldPreset preset = WorldPreset::kCampus;
  double width_m = 120.0;  ///< of the site, east-west
  double depth_m = 90.0;   ///< north-south
  double margin_m = 25.0;  ///< of world in full detail around the site
  double relief_m = 0.8;   ///< amplitude of the hills; 0 = level
  double texel_m = 0.05;   ///< of the stored picture and heights; half of it near a drive
};

/// The light and the traffic of an hour: what makes two visits of one place look different.
struct Appearance {
  double sun_heading_deg = 160.0;  ///< where the sun stands, clockwise from north
  double sun_elevation_deg = 52.0;
  double dryness = 0.15;           ///< tint of all plants: 0 = fresh, 1 = straw
  double car_share = 0.6;          ///< of the parking places that are taken
  double cars_per_km = 25.0;       ///< of street, under way: they move, and no truth shows them
  std::uint64_t traffic_seed = 1;  ///< which places, and by which cars
};

/// Late morning in spring, as a drone flies.
Appearance flight_appearance();
/// An afternoon some weeks later: other shadows, drier lawns, other cars.
Appearance drive_appearance();

void declare(OptionTable& table, WorldOptions& options);
/// Throws Error (usage) where a value is out of its range.
void check(WorldOptions& options);
/// `name` is "flight" or "drive": the options are called simulation.<name>_….
void declare(OptionTable& table, const std::string& name, Appearance& appearance);

/// The coordinate reference system of made worlds, as WKT.
std::string utm_zone_32_north();

/// Where the local metres of a world lie on earth: a UTM grid of WGS84. They are metres of the
/// grid; by default that lies so far from the central meridian of its zone that they are metres on
/// the ground too, to 3e-6 (elsewhere in a zone to 4e-4).
struct SiteAnchor {
  double easting_m = 320000.0;  ///< of the local origin
  double northing_m = 5500000.0;
  double altitude_m = 180.0;  ///< above the ellipsoid, of local height 0
  int utm_zone = 32;          ///< negative south of the equator
  std::string crs = utm_zone_32_north();

  /// From local metres; to 0.01 mm (Krueger's series of order 4, as in Karney, "Transverse Mercator
  /// with an accuracy of a few nanometers", 2011).
  GeodeticPosition geodetic(const Point3<frames::Map>& point) const;
  /// Heading of the grid's north, clockwise from true north, radians.
  double convergence(const Point3<frames::Map>& point) const;
  /// The same raster and pose in metres of the grid.
  GeoReference on_grid(const GeoReference& local) const;
  Pose2 on_grid(const Pose2& local) const;
};

class SimulatedScene;

/// A place with exact truth. The map frame is local: metres, x east, y north, the site's south-west
/// corner at (0, 0), z = 0 the height around it. Cheap to copy; thread-safe.
class SimulatedWorld {
 public:
  /// The same seed and options give the same world. Throws Error (usage) where an option is out of
  /// its range.
  static SimulatedWorld make(std::uint64_t seed, const WorldOptions& options);
  /// A world whose ground shows an orthomosaic, with the heights of a surface model where there is
  /// one. Holes of the mosaic show as plain grey, holes of the model as its lowest height. Where
  /// the map lies on a grid of `utm_zone` (negative in the south), WGS84, so does the world;
  /// without, it lies where a SiteAnchor lies by default. Throws Error (input) for a map without
  /// pixels or less than 10 m wide, and for a surface that covers less than half of it.
  static SimulatedWorld drape(const Orthomosaic& map, const std::optional<ElevationMap>& surface,
                              std::uint64_t seed = 1, std::optional<int> utm_zone = {});

  double width_m() const;
  double depth_m() const;
  const SiteAnchor& anchor() const;
  /// Height of the bare ground: kerbs included, cars, houses and trees not.
  double ground_height(double x, double y) const;
  /// Paths for a robot to drive: places half a metre apart with their headings. Where the world
  /// has lanes they are the middles of roads.
  std::vector<std::vector<Pose2>> routes() const;
  bool has_lanes() const;  ///< every world but a draped one
  /// The place in the light and traffic of an hour.
  SimulatedScene seen(const Appearance& appearance) const;

  const std::shared_ptr<const simulation::Terrain>& terrain() const { return terrain_; }

 private:
  explicit SimulatedWorld(std::shared_ptr<const simulation::Terrain> terrain)
      : terrain_(std::move(terrain)) {}

  std::shared_ptr<const simulation::Terrain> terrain_;
};

/// A world at an hour: what sensors see. Cheap to copy; all calls but refine() are thread-safe.
class SimulatedScene {
 public:
  explicit SimulatedScene(std::shared_ptr<simulation::Scene> scene) : scene_(std::move(scene)) {}

  /// Height of what is seen from straight above: roofs, cars and crowns too.
  double surface_height(double x, double y) const;
  /// The exact view from straight above, at noon exposure, without sensor: every pixel valid.
  /// `geo` in local metres.
  Orthomosaic true_orthomosaic(const GeoReference& geo, int width, int height) const;
  ElevationMap true_surface(const GeoReference& geo, int width, int height) const;
  /// Whether the straight line between two points is free.
  bool sees(const Point3<frames::Map>& from, const Point3<frames::Map>& to) const;
  /// Draws the ground within `radius_m` of the places in its finest detail; a drive does so.
  void refine(std::span<const Pose2> places, double radius_m);

  const simulation::Scene& scene() const { return *scene_; }

 private:
  std::shared_ptr<simulation::Scene> scene_;
};

}  // namespace nadir
