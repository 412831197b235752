// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "nadir/core/orthomosaic.hpp"
#include "nadir/core/sensors.hpp"

namespace nadir::testing {

inline constexpr int kSmallDriveFrames = 24;
inline constexpr double kSmallDriveStepM = 0.52;

/// A stereo drive over a textured plane in a gentle curve, ray-cast here; poses are exact. Written
/// once, in KITTI's layout, with its truth in the frame of small_drive_map().
std::filesystem::path small_drive();
/// A copy to spoil.
std::filesystem::path copy_of_small_drive(const std::string& name);
/// The plane from above, as a GeoTIFF.
std::filesystem::path small_drive_map();

StereoRig small_drive_rig();
StereoFrame small_drive_frame(int number);
OdomPose3 small_drive_pose(int number);

}  // namespace nadir::testing
