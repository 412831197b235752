// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "nadir/aerial_mapping/ortho/cells.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// Mean colour of two views over the cells that both see.
struct Overlap {
  std::size_t first = 0;
  std::size_t second = 0;
  double cells = 0.0;
  std::array<double, 3> first_mean{};
  std::array<double, 3> second_mean{};
};

/// Of every two views that overlap enough. Throws Stopped.
std::vector<Overlap> overlaps_of(const std::vector<ViewCells>& cells, const StopToken& stop);

/// Gains (red, green, blue) that make the views agree where they overlap: one for luminance, held
/// by `prior_sigma` around what the exposure says, and a chroma within 5 per cent; equation [10] of
/// docs/aerial-mapping.md. The median luminance gain is 1.
std::vector<std::array<float, 3>> balance(const std::vector<Overlap>& overlaps,
                                          const std::vector<std::optional<double>>& exposures,
                                          double prior_sigma);

}  // namespace nadir::aerial
