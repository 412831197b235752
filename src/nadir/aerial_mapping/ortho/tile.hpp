// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>

#include "nadir/aerial_mapping/options.hpp"
#include "nadir/aerial_mapping/ortho/cells.hpp"
#include "nadir/aerial_mapping/ortho/ground.hpp"
#include "nadir/aerial_mapping/ortho/views.hpp"
#include "nadir/core/geo_reference.hpp"

namespace nadir::aerial {

/// All that a tile of the orthomosaic is made from.
struct Scene {
  const std::vector<View>& views;
  const Ground& ground;
  const CellGrid& grid;
  const cv::Mat& labels;  ///< of the grid's cells
  ViewImages& images;
  GeoReference geo;  ///< of the map; its corner is the grid's
  BlendKind blend = BlendKind::kMultiBand;
  int bands = 5;
};

/// Colours of a part of the map, RGB; what no view gives is black.
cv::Mat render(const Scene& scene, const cv::Rect& part);

}  // namespace nadir::aerial
