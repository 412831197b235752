// SPDX-License-Identifier: Apache-2.0
#include "nadir/map_matching/quads.hpp"

namespace nadir {

Quads pack_quads(const Raster<std::uint8_t>& value, const Raster<std::uint8_t>& valid) {
  Quads quads{Raster<std::uint32_t>(value.width() + 2 * Quads::kMargin,
                                    value.height() + 2 * Quads::kMargin)};
  for (int row = 0; row + 1 < value.height(); ++row) {
    for (int column = 0; column + 1 < value.width(); ++column) {
      if ((valid.at(column, row) & valid.at(column + 1, row) & valid.at(column, row + 1) &
           valid.at(column + 1, row + 1)) == 0) {
        continue;
      }
      quads.words.at(column + Quads::kMargin, row + Quads::kMargin) =
          std::uint32_t{value.at(column, row)} | (std::uint32_t{value.at(column + 1, row)} << 8U) |
          (std::uint32_t{value.at(column, row + 1)} << 16U) |
          (std::uint32_t{value.at(column + 1, row + 1)} << 24U);
    }
  }
  return quads;
}

}  // namespace nadir
