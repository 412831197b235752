// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "nadir/map_matching/cuda/device_map.hpp"

namespace nadir::cuda {

/// The exact scores of poses, one block of the device for each.
std::vector<PoseScore> score_poses_on(DeviceMap& on_device, const MapIndex& map,
                                      const Template& local, std::span<const Pose2> poses);

}  // namespace nadir::cuda
