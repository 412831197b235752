// SPDX-License-Identifier: Apache-2.0
// The preset `parking`: a large car park beside a street, with islands of trees.
#include "nadir/simulation/scene/planning.hpp"

namespace nadir::simulation {

Layout lay_out_parking(std::uint64_t seed, double width_m, double depth_m) {
  Planner plan(seed, width_m, depth_m);
  const auto at = [&](double x, double y) { return plan.at(x, y); };
  const double street_y = plan.draw(0.12, 0.16);
  plan.add_road(
      plan.path({at(-0.6, street_y), at(0.45, street_y + 0.02), at(1.6, street_y - 0.03)}, {60.0}),
      3.5, RoadKind::kStreet);
  plan.layout.roads[0].crossings = {plan.layout.roads[0].path.locate(at(0.35, street_y)).along};
  // Three double rows; lanes lead round them.
  const double half_length = 0.37 * width_m;
  const double first = 0.36 * depth_m;
  for (int row = 0; row < 3; ++row) {
    plan.add_area(0.5, (first + 19.0 * row) / depth_m, half_length, 8.5, AreaKind::kParking);
  }
  const double last_y = (first + 38.0) / depth_m;
  for (const double x : {0.10, 0.90}) {
    plan.add_road(plan.path({at(x, street_y), at(x, last_y + 0.03)}, {1.0}, false), 3.0,
                  RoadKind::kLane);
  }
  for (int row = 0; row < 3; ++row) {
    const double y = (first + 19.0 * row) / depth_m;
    plan.add_road(plan.path({at(0.10, y), at(0.90, y)}, {1.0}, false), 3.0, RoadKind::kLane);
  }
  const double middle_y = first / depth_m;
  const std::vector<Eigen::Vector2d> round{at(0.02, street_y + 0.001), at(0.10, street_y + 0.004),
                                           at(0.10, middle_y),         at(0.90, middle_y),
                                           at(0.90, last_y),           at(0.14, last_y)};
  const std::vector<double> radii{7.0, 6.0, 6.0, 6.0};
  plan.layout.routes.emplace_back(round, radii, false);
  plan.try_building(0.5, 1.10, 0.3 * width_m, 9.0, 7.5, false);
  plan.try_building(0.2, -0.12, 8.0, 5.0, 5.0, true);
  plan.try_building(0.7, -0.12, 8.0, 5.0, 5.0, true);
  plan.add_hedge(at(0.15, street_y + 0.075), at(0.84, street_y + 0.075), true);
  plan.add_hedge(at(0.99, 0.3), at(0.99, 0.85), true);
  plan.add_street_furniture();
  plan.add_trees(70, 1.2, 2.8);
  plan.add_parking_stalls(0.3);
  return plan.layout;
}

}  // namespace nadir::simulation
