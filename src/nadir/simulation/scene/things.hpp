// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "nadir/simulation/scene/layout.hpp"
#include "nadir/simulation/scene/solid.hpp"

namespace nadir::simulation {

/// A car: where it stands, on which height, and which of the models and paints it has.
struct Car {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw = 0.0;
  double ground = 0.0;
  std::uint64_t seed = 0;
};

void add_building(const Building& building, double ground, std::uint64_t seed,
                  std::vector<Solid>& solids);
void add_tree(const Tree& tree, double ground, std::uint64_t seed, std::vector<Solid>& solids);
void add_barrier(const Barrier& barrier, double ground, std::uint64_t seed,
                 std::vector<Solid>& solids);
void add_post(const Post& post, double ground, std::vector<Solid>& solids);
void add_car(const Car& car, std::vector<Solid>& solids);

}  // namespace nadir::simulation
