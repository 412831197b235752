// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "nadir/core/sensors.hpp"

namespace nadir {

/// The points of a file, and what was left out of it.
struct PointCloud {
  std::vector<LidarPoint> points;
  /// Points that are not finite, or that lie in the sensor itself (a beam without an echo).
  std::size_t invalid = 0;
  /// Bytes at the end of a .bin that make no whole point: the file is cut off.
  std::size_t leftover_bytes = 0;
};

/// Reads by extension: .bin (Velodyne as KITTI has it: float32 x y z intensity, little-endian),
/// .pcd (ascii, binary, binary_compressed), .ply (ascii, binary of either order). Fields other than
/// x, y, z, intensity and time are skipped. Throws Error (input) for a missing, empty, damaged or
/// Git LFS pointer file, another extension, a field that is missing, and a file without a valid
/// point.
PointCloud read_point_cloud(const std::filesystem::path& path);

/// Writes float32 x y z intensity, little-endian, atomically.
void write_velodyne(const std::filesystem::path& path, const std::vector<LidarPoint>& points);

/// Writes a binary little-endian PLY of x, y, z, intensity, atomically.
void write_ply(const std::filesystem::path& path, const std::vector<LidarPoint>& points);

}  // namespace nadir
