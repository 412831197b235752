// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "nadir/core/random.hpp"
#include "nadir/simulation/scene/layout.hpp"

namespace nadir::simulation {

/// What the presets share: a place is planned in a fixed base shape, jittered and mirrored by its
/// seed, and furnished by the same rules.
class Planner {
 public:
  Planner(std::uint64_t seed, double width_m, double depth_m);

  /// Share of the site in x and y -> local metres, mirrored as the seed says.
  Eigen::Vector2d at(double x, double y) const;
  double draw() { return random_.uniform(draws_++); }
  double draw(double low, double high) { return low + (high - low) * draw(); }

  static Path path(std::initializer_list<Eigen::Vector2d> corners,
                   std::initializer_list<double> radii, bool endless = true);
  void add_road(Path path, double half_width, RoadKind kind);
  void add_area(double x, double y, double half_length, double half_width, AreaKind kind);
  /// A building where there is room for it.
  void try_building(double x, double y, double half_length, double half_width, double height,
                    bool gable);
  void add_hedge(const Eigen::Vector2d& from, const Eigen::Vector2d& to, bool hedge);
  void add_street_furniture();
  void add_trees(int count, double smallest, double largest);
  void add_parking_stalls(double from_edge);

  Layout layout;

 private:
  bool is_furnished(const Eigen::Vector2d& p) const;
  bool is_clear_of_others(const Road& road, const Eigen::Vector2d& p, double clearance) const;
  void add_decals(const Road& road);
  void add_arrows(const Road& road);
  void add_lamps(const Road& road);
  void add_street_trees(const Road& road);

  RandomStream random_;
  std::uint64_t draws_ = 0;
  double width_;
  double depth_;
  bool flip_x_;
  bool flip_y_;
};

}  // namespace nadir::simulation
