// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "nadir/evaluation/evaluation.hpp"

namespace nadir {

/// The relative errors over all consecutive stretches of `delta`, in both parts.
struct RelativeErrors {
  std::vector<double> translation_m;
  std::vector<double> angle_rad;  ///< absolute
};

/// (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) for truth Q, estimate P (Sturm et al., "A benchmark for the
/// evaluation of RGB-D SLAM systems", IROS 2012, equation 3). The stretches follow one another
/// without overlap and are measured on the truth (evo: --pairs_from_reference, no --all_pairs).
RelativeErrors relative_errors(std::span<const PosePair> pairs, double delta, DeltaUnit unit);

}  // namespace nadir
