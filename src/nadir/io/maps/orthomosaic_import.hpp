// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nadir/core/orthomosaic.hpp"

namespace nadir {

/// A border that a program filled with one colour instead of marking it.
enum class Collar { kNone, kWhite, kBlack };

struct ImportOptions {
  std::optional<double> resolution_m;  ///< of the result; none = that of the file
  /// Of an image without a geo-reference: the size of its pixels, or two of them (column, row) and
  /// the distance between them in metres.
  std::optional<double> metres_per_pixel;
  std::optional<std::array<double, 4>> points_px;
  std::optional<double> distance_m;
  std::string crs;  ///< where the file names none: "EPSG:32651" and the like
  Collar collar = Collar::kNone;
  /// Of the result: a thin image that lies askew, or a fine resolution, may give far more pixels
  /// than the file has.
  double most_megapixels = 1000.0;
};

struct ImportedOrthomosaic {
  Orthomosaic map;
  std::vector<std::string> notes;  ///< what was changed, one sentence each
};

/// Takes in a map that another program made, whatever its grid and pixels: reads what
/// `read_orthomosaic` reads, and
///   warps rotated, sheared, flipped and oblong grids to north-up squares;
///   warps geographic, Mercator (EPSG:3857) and non-metric grids to the UTM zone of their centre;
///   turns palettes into RGB, and stretches pixels of more than 8 bits: the 1st to the 99th
///   percentile of all colours together become 0 to 255;
///   averages by area to a coarser `resolution_m`;
///   takes a `collar` (within 5 grey levels of white or black, joined to the border) for a hole.
/// Throws Error (input) for what cannot be read, CMYK, other numbers of bands, places beyond UTM,
/// a file without geo-reference where no option gives one, one without any valid pixel, and a
/// result that would be too large; Error (usage) for options that contradict each other.
ImportedOrthomosaic import_orthomosaic(const std::filesystem::path& path,
                                       const ImportOptions& options = {});

}  // namespace nadir
