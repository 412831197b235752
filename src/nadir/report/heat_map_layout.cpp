// SPDX-License-Identifier: Apache-2.0
#include "nadir/report/heat_map_layout.hpp"

#include <algorithm>

namespace nadir::report {
namespace {

constexpr double kPatchCaption = 40.0;
constexpr double kPatchGap = 36.0;
constexpr double kColourBarRoom = 130.0;  ///< the colour bar with its tick labels

/// The map at the left, colour bar and the three patches beside it, legend below.
HeatMapLayout lay_out_beside(const Region& region) {
  HeatMapLayout layout;
  const double top = kMargin + kTitleHeight;
  constexpr double kPatches = 3.0 * (kPatchSide + kPatchCaption) + 2.0 * 14.0;
  layout.view = fit(region, {kMargin + tick_room(region), top, 1330.0, kPatches});
  const Box& map = layout.view.box;
  layout.bar = {map.right() + 30.0, top + kPatchCaption, 26.0,
                std::min(640.0, map.height - kPatchCaption)};
  const double left = layout.bar.left + kColourBarRoom;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto row = static_cast<double>(i);
    layout.patches[i] = {left, top + kPatchCaption + row * (kPatchSide + kPatchCaption + 14.0),
                         kPatchSide, kPatchSide};
  }
  layout.width = static_cast<int>(left + kPatchSide + kMargin);
  const double below = std::max(map.bottom() + kTickRoom, top + kPatches) + 26.0;
  layout.legend = {map.left, below, 0.0, 66.0};
  layout.furniture = {layout.width - kMargin - 300.0, below, 300.0, 120.0};
  layout.height = static_cast<int>(below + 120.0 + kMargin - 20.0);
  return layout;
}

/// The map above, the patches, the legend and the scale in a row below.
HeatMapLayout lay_out_above(const Region& region) {
  HeatMapLayout layout;
  const double top = kMargin + kTitleHeight;
  layout.view = fit(region, {kMargin + tick_room(region), top, 1640.0, 1200.0});
  const Box& map = layout.view.box;
  layout.bar = {map.right() + 30.0, top + kPatchCaption, 26.0,
                std::min(640.0, map.height - kPatchCaption)};
  const double row = map.bottom() + kTickRoom + 20.0 + kPatchCaption;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto column = static_cast<double>(i);
    layout.patches[i] = {map.left + column * (kPatchSide + kPatchGap), row, kPatchSide, kPatchSide};
  }
  const double left = layout.patches[2].right() + kPatchGap;
  layout.legend = {left, row, 0.0, 0.0};
  layout.furniture = {left, row + kPatchSide - 110.0, 380.0, 110.0};
  layout.width =
      static_cast<int>(std::max(map.right() + kColourBarRoom, left + 380.0) + kMargin - 10.0);
  layout.height = static_cast<int>(row + kPatchSide + kMargin);
  return layout;
}

}  // namespace

HeatMapLayout lay_out_heat_map(const Region& region) {
  return region.width() > 1.25 * region.height() ? lay_out_above(region) : lay_out_beside(region);
}

}  // namespace nadir::report
