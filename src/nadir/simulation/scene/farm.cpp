// SPDX-License-Identifier: Apache-2.0
// The preset `farm`: fields of crops in rows, gravel tracks, a yard with barns.
#include <cmath>

#include "nadir/core/angle.hpp"
#include "nadir/simulation/scene/planning.hpp"

namespace nadir::simulation {

Layout lay_out_farm(std::uint64_t seed, double width_m, double depth_m) {
  Planner plan(seed, width_m, depth_m);
  const auto at = [&](double x, double y) { return plan.at(x, y); };
  const double track_y = plan.draw(0.44, 0.50);
  const double cross_x = plan.draw(0.62, 0.68);
  plan.add_road(plan.path({at(-0.6, track_y), at(0.3, track_y + 0.02), at(0.62, track_y - 0.03),
                           at(1.6, track_y + 0.05)},
                          {50.0, 50.0}),
                1.9, RoadKind::kTrack);
  plan.add_road(
      plan.path({at(cross_x, track_y), at(cross_x + 0.02, 0.75), at(cross_x, 1.5)}, {40.0}, false),
      1.7, RoadKind::kTrack);
  const Eigen::Vector2d corner = at(cross_x, track_y - 0.02);
  const std::vector<Eigen::Vector2d> round{at(0.03, track_y + 0.003), at(0.3, track_y + 0.02),
                                           corner, at(cross_x + 0.02, 0.75),
                                           at(cross_x + 0.004, 1.05)};
  const std::vector<double> radii{50.0, 8.0, 40.0};
  plan.layout.routes.emplace_back(round, radii, false);
  plan.add_area(0.84, track_y + 0.20, 0.10 * width_m, 0.11 * depth_m, AreaKind::kGravelYard);
  plan.add_area(0.29, track_y + 0.34, 0.29 * width_m, 0.24 * depth_m, AreaKind::kCrop);
  plan.add_area(0.22, track_y - 0.33, 0.33 * width_m, 0.25 * depth_m, AreaKind::kCrop);
  plan.add_area(0.82, track_y - 0.35, 0.22 * width_m, 0.25 * depth_m, AreaKind::kCrop);
  // Rows run one way in one field and across it in the next.
  plan.layout.areas[2].yaw = radians(1.5);
  Area& last = plan.layout.areas[3];
  last.yaw = radians(90.0);
  std::swap(last.half_length, last.half_width);
  plan.try_building(0.84, track_y + 0.40, 10.0, 5.0, 5.0, true);
  plan.try_building(1.02, track_y + 0.22, 5.0, 7.0, 4.5, true);
  plan.try_building(0.88, track_y + 0.57, 6.0, 4.5, 5.0, true);
  plan.add_hedge(at(0.72, track_y + 0.09), at(0.98, track_y + 0.10), false);
  plan.add_hedge(at(0.02, track_y + 0.61), at(0.56, track_y + 0.61), true);
  plan.add_trees(60, 1.5, 3.4);
  return plan.layout;
}

}  // namespace nadir::simulation
