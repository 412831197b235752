// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "nadir/simulation/scene/path.hpp"

namespace nadir::simulation {

enum class RoadKind { kStreet, kLane, kFootway, kTrack };

/// A road and what is painted on it. A street has kerbs, pavements and markings; a lane is asphalt
/// without; a footway is paved; a track is gravel.
struct Road {
  Path path;
  double half_width = 3.5;
  RoadKind kind = RoadKind::kStreet;
  std::vector<double> crossings;  ///< along, middles of the zebra crossings
};

enum class AreaKind { kParking, kPlaza, kGravelYard, kCrop, kBed };

/// A rectangle of ground, turned by `yaw`.
struct Area {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double yaw = 0.0;
  double half_length = 1.0;  ///< along yaw
  double half_width = 1.0;
  AreaKind kind = AreaKind::kPlaza;
  std::uint32_t number = 0;  ///< picks the random numbers

  Eigen::Vector2d local(const Eigen::Vector2d& point) const;
  Eigen::Vector2d place(const Eigen::Vector2d& local) const;
  /// Distance from the edge, metres: negative inside.
  double outside(const Eigen::Vector2d& point) const;
};

/// Rows of stalls of a parking area: across its width, from both long edges, in local coordinates.
inline constexpr double kStallWidth = 2.5;
inline constexpr double kStallDepth = 5.0;

enum class DecalKind { kManhole, kDrain, kArrow, kPatch };

/// Something flat on the ground.
struct Decal {
  DecalKind kind = DecalKind::kManhole;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0.0;
  double half_length = 0.3;
  double half_width = 0.3;
  float tone = 0.0F;
};

struct Building {
  Area plan;
  double height = 6.0;  ///< to the eaves
  bool gable = false;
  std::uint32_t look = 0;
};

struct Tree {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double height = 8.0;
  double crown = 2.5;  ///< radius
  std::uint32_t number = 0;
};

struct Barrier {
  Area plan;
  double height = 1.2;
  bool hedge = true;  ///< else a wall
};

/// A place where a car may stand.
struct Stall {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0.0;
};

struct Post {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double height = 5.0;
  double yaw = 0.0;
};

/// What a place is made of, before it is drawn. Local metres, south-west corner of the site at
/// (0, 0).
struct Layout {
  std::vector<Road> roads;
  std::vector<Area> areas;
  std::vector<Decal> decals;
  std::vector<Building> buildings;
  std::vector<Tree> trees;
  std::vector<Barrier> barriers;
  std::vector<Stall> stalls;
  std::vector<Post> posts;
  std::vector<Path> routes;  ///< for a robot to drive
  bool painted = true;       ///< false: the ground is an image that is draped
};

inline constexpr double kKerbWidth = 0.10;  ///< of its top
inline constexpr double kKerbFace =
    0.08;  ///< of its face, which leans: the ground is a function of the plane
inline constexpr double kKerbHeight = 0.12;
inline constexpr double kPavementWidth = 2.4;  ///< with the kerb
inline constexpr double kCornerRadius = 5.0;   ///< of the kerbs of a junction

/// The distance from the union of two shapes, given the distances from both: the corner between
/// them is rounded with `radius`.
double rounded_union(double a, double b, double radius);

/// Free of roads, areas and buildings by `clearance` metres.
bool is_free(const Layout& layout, const Eigen::Vector2d& point, double clearance);

Layout lay_out_campus(std::uint64_t seed, double width_m, double depth_m);
Layout lay_out_parking(std::uint64_t seed, double width_m, double depth_m);
Layout lay_out_farm(std::uint64_t seed, double width_m, double depth_m);

}  // namespace nadir::simulation
