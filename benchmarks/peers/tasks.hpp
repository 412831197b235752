// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "peers/contest.hpp"
#include "peers/scene.hpp"

namespace nadir::bench {

struct Effort {
  int rounds = 7;
  int brute_force_stride = 10;  ///< along rows and columns; times are multiplied
  std::size_t reference_poses = 1000;
};

Timings table_one(const Scene& scene, const Effort& effort);
Timings whole_map(const Scene& scene, const Effort& effort);
Timings all_headings(const Scene& scene, const Effort& effort);
Timings thousand_particles(const Scene& scene, const Effort& effort);

/// How many frames the coarse-to-fine search loses against the full one: it finds another place
/// that scores less. Prints what it finds.
int frames_lost(const std::filesystem::path& data);

}  // namespace nadir::bench
