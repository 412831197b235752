// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/ortho/views.hpp"
#include "nadir/core/geo_reference.hpp"
#include "nadir/core/stop.hpp"

namespace nadir::aerial {

/// A coarse grid over the map, `pixels` map pixels to a cell, on which views are chosen and gains
/// are measured.
struct CellGrid {
  GeoReference geo;  ///< resolution = side of a cell
  int width = 0;
  int height = 0;
  int pixels = 4;
};

/// How one view sees the cells of its part of the grid.
struct ViewCells {
  cv::Rect rect;   ///< of the grid; empty where the view sees nothing
  cv::Mat cost;    ///< float: smaller = better seen; infinite = not seen
  cv::Mat colour;  ///< RGB as the photo has it, a mean over the cell
};

/// Looks at the grid through every view, in parallel. Throws Stopped.
std::vector<ViewCells> look(const std::vector<View>& views, const Ground& ground,
                            const CellGrid& grid, const ViewLimits& limits, ViewImages& images,
                            const StopToken& stop);

/// How many views see each cell, at most 255.
cv::Mat count_views(const std::vector<ViewCells>& cells, const CellGrid& grid);

inline constexpr std::uint16_t kNoView = 65535;
/// Views, by number, that labels can name.
inline constexpr std::size_t kMostLabels = kNoView;

/// Lowers all gains alike until hardly any cell of the map is brighter than it can be shown, by a
/// fourth at most: photos that were exposed for dark woods are darker than bright ground needs.
void keep_from_clipping(const std::vector<ViewCells>& cells, const cv::Mat& labels,
                        std::vector<View>& views);

/// The view that each cell takes its colour from (16 bit, kNoView = none): the one that sees it
/// best, with the borders moved to where neighbouring views look alike. Throws Stopped.
cv::Mat choose_views(const std::vector<ViewCells>& cells, const std::vector<View>& views,
                     const CellGrid& grid, bool optimise_seams, const StopToken& stop);

}  // namespace nadir::aerial
