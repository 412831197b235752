// SPDX-License-Identifier: Apache-2.0
#pragma once

// The names that the reader and the writer of a site share; docs/formats.md explains them.

namespace nadir::sequence_format {

inline constexpr const char* kIndexFile = "sequence.yaml";
inline constexpr int kVersion = 1;
inline constexpr const char* kMapFile = "map.tif";
inline constexpr const char* kSurfaceFile = "surface.tif";
inline constexpr const char* kLocalMapFolder = "local";
inline constexpr const char* kOdometryFile = "odometry.tum";
inline constexpr const char* kTruthFile = "truth.tum";
inline constexpr const char* kCalibrationFile = "calibration.yaml";

}  // namespace nadir::sequence_format
