// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "localize_run.hpp"
#include "nadir/core/stop.hpp"
#include "nadir/evaluation/evaluation.hpp"

namespace nadir::cli {

struct RunFigures {
  const Orthomosaic& map;
  const RunResult& result;
  const Trajectory& truth;       ///< may be empty
  Trajectory odometry;           ///< alone, from the start on; may be empty
  const Evaluation* evaluation;  ///< where there is a truth
  std::string title;
};

/// Where the odometry alone would have led over the frames of a run, from their first true pose or,
/// without a truth, from the first estimate.
Trajectory odometry_alone(const Odometry& odometry, const RunResult& result,
                          const Trajectory& truth);

/// Draws trajectory.png, swarm.png, comparison.png, coverage.png, diagnostics.png and, where there
/// is a truth, error.png into the folder; returns their names. Throws Stopped between them.
std::vector<std::string> draw_run(const std::filesystem::path& folder, const RunFigures& figures,
                                  const StopToken& stop);

}  // namespace nadir::cli
