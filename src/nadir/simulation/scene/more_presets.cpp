// SPDX-License-Identifier: Apache-2.0
#include "nadir/simulation/scene/planning.hpp"

namespace nadir::simulation {

Layout lay_out_parking(std::uint64_t seed, double width_m, double depth_m) {
  return lay_out_campus(seed, width_m, depth_m);
}

Layout lay_out_farm(std::uint64_t seed, double width_m, double depth_m) {
  return lay_out_campus(seed, width_m, depth_m);
}

}  // namespace nadir::simulation
