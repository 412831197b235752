// SPDX-License-Identifier: Apache-2.0
#include "nadir/runs/particle_log.hpp"
#include "fuzz/fuzz_target.hpp"

NADIR_FUZZ_TARGET(particle_log) {
  nadir::ParticleLogReader log(nadir::fuzz::as_file("particles.bin", input));
  log.anchor();
  std::size_t particles = 0;
  for (std::size_t frame = 0; frame < 1000; ++frame) {
    const auto cloud = log.read(frame);
    if (!cloud) break;
    particles += cloud->size();
  }
  nadir::fuzz::require(particles * sizeof(nadir::LoggedParticle) <= input.size(),
                       "more particles than bytes");
}
