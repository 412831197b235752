// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "nadir/core/frames.hpp"
#include "nadir/core/orthomosaic.hpp"

namespace nadir::bench {

/// A map and one local map with its place in it.
struct Scene {
  Orthomosaic map;
  Orthomosaic local;
  Pose2 truth;
};

/// A seeded place of the size of the Aero-Ground run: 416 x 1158 px, a local map of 180 x 180 px
/// with a third of it holes.
Scene synthetic_scene();

/// Frames of the Aero-Ground run that have a truth: `folder` holds global_no_cars.jpg, local/ and
/// truth.txt, or a folder `aeroground` that does.
std::vector<int> truth_frames(const std::filesystem::path& folder);
Scene aeroground_scene(const std::filesystem::path& folder, int frame);

}  // namespace nadir::bench
