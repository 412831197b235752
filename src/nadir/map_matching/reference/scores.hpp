// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "nadir/map_matching/options.hpp"

namespace nadir::reference {

/// The pixels of a template and of the map below it that take part in a score, pair by pair.
struct PixelPairs {
  std::vector<double> map;     ///< R
  std::vector<double> local;   ///< P
  std::vector<double> weight;  ///< w; 1 for the unweighted scores
};

/// The definition of every score (docs/scores.md), in double and without any shortcut: the oracle
/// of every test. NaN for no pixels or where a norm or a variance (under 1 grey^2) leaves the score
/// undefined.
double score(Score score, const PixelPairs& pairs);

}  // namespace nadir::reference
