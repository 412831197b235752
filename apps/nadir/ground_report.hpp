// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "cli/streams.hpp"
#include "drive_mapping.hpp"

namespace nadir::cli {

/// What `nadir ground` says at its end.
struct GroundReport {
  int frames = 0;
  int local_maps = 0;
  int low_coverage = 0;     ///< of the local maps
  double length_m = 0.0;    ///< driven
  double coverage_18m = 0;  ///< seen around the last pose; NaN where the grid is smaller
  double coverage_9m = 0;
  PoseFit pose_fit;
  std::optional<MapComparison> comparison;
  std::vector<std::pair<std::string, double>> ms_per_frame;  ///< stage, median
  std::vector<std::string> warnings;
  std::vector<std::string> doubts;  ///< the first of the warnings
};

GroundReport report_of(const DriveMapping& mapping, const std::vector<double>& render_ms,
                       int low_coverage);

/// Exactly the keys of docs/formats.md.
Json to_json(const GroundReport& report);
std::string to_table(const GroundReport& report);

/// frames.csv: of every frame status, points, dropped classes, cells, ms.
std::string frames_csv(const std::vector<MappedFrame>& frames);

}  // namespace nadir::cli
