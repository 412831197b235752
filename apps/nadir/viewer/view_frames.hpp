// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/streams.hpp"
#include "localize_run.hpp"

namespace nadir::cli {

/// What is shown of one frame of a run.
struct ViewFrame {
  int number = 0;
  Stamp stamp;
  std::string status;
  Pose2 map_from_robot;
  PoseCovariance covariance = PoseCovariance::Zero();
  double effective_particles = 0.0;
  double best_score = 0.0;
  double valid_weight = 0.0;
  double cluster_mass = 0.0;
  int clusters = 0;
  bool resampled = false;
  double decode_ms = 0.0;
  double update_ms = 0.0;
  std::optional<Pose2> truth;
};

/// The frames of a run folder, from trajectory.tum, covariance.csv, frames.csv and timing.csv; the
/// truth stays empty. Throws Error (input) with file:line where one is missing, damaged or of
/// another length.
std::vector<ViewFrame> read_view_frames(const std::filesystem::path& run);

/// The frame of a run that goes on.
ViewFrame view_of(const FrameRecord& record, const Sequence& sequence);

/// A frame as the viewer's page takes it; radians, null for what is not finite or not known.
Json to_json(const ViewFrame& frame);

}  // namespace nadir::cli
