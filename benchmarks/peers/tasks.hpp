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

/// How many of the frames the coarse-to-fine search loses against the full one: it finds another
/// place, half a metre away, that scores less. Prints where the two differ at all.
int frames_lost(const std::filesystem::path& data, const std::vector<int>& frames);

}  // namespace nadir::bench
