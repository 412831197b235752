// SPDX-License-Identifier: Apache-2.0
// The preset `campus`: two streets that cross, a car park, a plaza, houses and lawns.
#include "nadir/simulation/scene/planning.hpp"

namespace nadir::simulation {
namespace {

void add_streets(Planner& plan) {
  const double main_y = plan.draw(0.29, 0.33);
  const double side_x = plan.draw(0.66, 0.71);
  const double arm_y = plan.draw(0.78, 0.82);
  const auto at = [&](double x, double y) { return plan.at(x, y); };
  plan.add_road(plan.path({at(-0.6, main_y), at(0.20, main_y - 0.03), at(0.46, main_y + 0.05),
                           at(0.60, main_y + 0.02), at(1.6, main_y + 0.06)},
                          {45.0, 40.0, 60.0}),
                3.5, RoadKind::kStreet);
  plan.add_road(plan.path({at(side_x, -0.8), at(side_x, arm_y), at(-0.6, arm_y - 0.03)}, {14.0}),
                3.25, RoadKind::kStreet);
  // A robot that keeps to the right lane: along the main street, into the side street and back.
  const Eigen::Vector2d corner = at(side_x, main_y + 0.02);
  const std::vector<Eigen::Vector2d> round{at(0.06, main_y - 0.01), at(0.20, main_y - 0.03),
                                           at(0.46, main_y + 0.05), corner,
                                           at(side_x, arm_y),       at(0.06, arm_y - 0.02)};
  const std::vector<double> radii{45.0, 40.0, 8.0, 14.0};
  plan.layout.routes.emplace_back(round, radii, false);
  Road& main_street = plan.layout.roads[0];
  Road& side_street = plan.layout.roads[1];
  const double crossing_along = main_street.path.locate(corner).along;
  main_street.crossings = {crossing_along - 13.0, crossing_along + 14.0, crossing_along - 55.0};
  const double side_along = side_street.path.locate(corner).along;
  side_street.crossings = {side_along - 13.0, side_along + 13.5};
  const double park_y = 0.5 * (main_y + arm_y) + 0.02;
  plan.add_area(0.40, park_y, 19.0, 8.5, AreaKind::kParking);
  plan.add_road(plan.path({at(0.52, park_y), at(side_x, park_y)}, {1.0}, false), 2.8,
                RoadKind::kLane);
}

void add_paths(Planner& plan) {
  const auto at = [&](double x, double y) { return plan.at(x, y); };
  plan.add_area(0.115, 0.42, 8.0, 4.0, AreaKind::kPlaza);
  plan.add_road(plan.path({at(0.19, 0.30), at(0.195, 0.55), at(0.21, 0.77)}, {20.0}, false), 1.1,
                RoadKind::kFootway);
  plan.add_road(plan.path({at(0.19, 0.68), at(0.40, 0.715), at(0.655, 0.69)}, {30.0}, false), 0.9,
                RoadKind::kFootway);
  plan.add_road(plan.path({at(0.73, 0.52), at(0.86, 0.47), at(1.0, 0.56), at(1.5, 0.50)},
                          {12.0, 14.0}, false),
                1.0, RoadKind::kTrack);
  plan.add_road(plan.path({at(0.33, -0.5), at(0.35, 0.12), at(0.31, 0.27)}, {25.0}, false), 1.0,
                RoadKind::kTrack);
  plan.add_area(0.27, 0.63, 3.0, 1.4, AreaKind::kBed);
  plan.add_area(0.80, 0.36, 3.2, 1.0, AreaKind::kBed);
}

void add_buildings(Planner& plan) {
  // Drawn one after the other: the order of a call's arguments is the compiler's.
  const auto build = [&](double x, double y, double half_length, double half_width, double height,
                         bool gable) {
    x += plan.draw(-0.012, 0.012);
    y += plan.draw(-0.012, 0.012);
    half_length *= plan.draw(0.88, 1.12);
    half_width *= plan.draw(0.88, 1.12);
    height *= plan.draw(0.88, 1.12);
    plan.try_building(x, y, half_length, half_width, height, gable);
  };
  build(0.085, 0.60, 7.0, 10.0, 9.0, false);
  build(0.88, 0.74, 11.0, 8.0, 8.0, false);
  build(0.90, 0.15, 9.0, 6.0, 6.5, false);
  build(0.10, 0.09, 6.0, 4.5, 5.0, true);
  build(0.25, 0.08, 5.5, 4.5, 5.0, true);
  build(0.47, 0.11, 8.0, 5.0, 5.5, true);
  for (int i = 0; i < 26; ++i) {  // the neighbourhood
    const bool gable = plan.draw() < 0.7;
    const double x = plan.draw(-0.18, 1.18);
    const double y = plan.draw() < 0.5 ? plan.draw(-0.24, 0.02) : plan.draw(0.9, 1.22);
    if (gable) build(x, y, 5.5, 4.4, 4.8, true);
    if (!gable) build(x, y, 8.0, 6.0, 7.0, false);
  }
}

void add_hedges(Planner& plan) {
  const Area park = plan.layout.areas.front();
  const double u = park.half_length + 1.2;
  const double v = park.half_width + 1.2;
  plan.add_hedge(park.place({-u, -v}), park.place({-u, v}), true);
  plan.add_hedge(park.place({-u, v}), park.place({-2.0, v}), true);
  plan.add_hedge(park.place({1.0, v}), park.place({u, v}), true);
  plan.add_hedge(park.place({-u, -v}), park.place({u, -v}), true);
  plan.add_hedge(plan.at(0.02, 0.20), plan.at(0.17, 0.185), true);
  plan.add_hedge(plan.at(0.18, 0.18), plan.at(0.29, 0.18), false);
  plan.add_hedge(plan.at(0.40, 0.235), plan.at(0.56, 0.26), true);
  plan.add_hedge(plan.at(0.76, 0.64), plan.at(0.98, 0.62), true);
  plan.add_hedge(plan.at(0.80, 0.27), plan.at(0.99, 0.26), false);
}

}  // namespace

Layout lay_out_campus(std::uint64_t seed, double width_m, double depth_m) {
  Planner plan(seed, width_m, depth_m);
  add_streets(plan);
  add_paths(plan);
  add_buildings(plan);
  add_hedges(plan);
  plan.add_street_furniture();
  plan.add_trees(90, 1.3, 3.4);
  plan.add_parking_stalls(0.3);
  return plan.layout;
}

}  // namespace nadir::simulation
