// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/report/figures.hpp"
#include "nadir/report/imagery.hpp"

namespace nadir::report {

/// A local map, what the map shows at a pose of the robot, and both in turn: upright in the robot's
/// frame, x forward to the right.
struct Patches {
  Imagery local;
  std::optional<Imagery> map;   ///< nothing where the pose is not finite
  std::optional<Imagery> both;  ///< a checkerboard: edges run on where both agree
};

/// The longer side becomes `side` pixels of the figure.
Patches patches_of(const Orthomosaic& map, const Orthomosaic& local, const Pose2& map_from_robot,
                   double side);

/// Draws one of them from the box's upper left corner, over hatching and in a frame.
void draw_patch(Canvas& canvas, const Box& box, const Imagery& imagery, const char* caption);

}  // namespace nadir::report
