// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "nadir/core/random.hpp"
#include "nadir/localization/options.hpp"
#include "nadir/localization/particle_set.hpp"

namespace nadir {

/// Draws `count` indices with probability proportional to `weights` (which sum to a positive
/// number). Systematic: one random number, equal spacing; stratified: one in each of `count` equal
/// strata; multinomial: independent draws, the paper's roulette. Ascending, but for multinomial.
std::vector<std::size_t> draw_indices(Resampling method, std::span<const double> weights,
                                      std::size_t count, const RandomStream& random);

/// 1 / sum of squared weights (Kong, 1994); the weights sum to 1.
double effective_sample_size(std::span<const double> weights);

/// How many particles the cloud needs so that its distance from the true posterior stays under
/// `kld_error` with 99 % confidence (Fox, "Adapting the sample size in particle filters through KLD
/// sampling", IJRR 2003), between `min_particles` and `particles`.
std::size_t kld_particles(const ParticleSet& particles, const LocalizationOptions& options);

}  // namespace nadir
