// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "localize_run.hpp"
#include "nadir/evaluation/evaluation.hpp"

namespace nadir::cli {

struct RunFigures {
  const Orthomosaic& map;
  const RunResult& result;
  const Trajectory& truth;       ///< may be empty
  const Evaluation* evaluation;  ///< where there is a truth
  std::string title;
};

/// Draws trajectory.png, swarm.png, comparison.png, coverage.png, diagnostics.png and, where there
/// is a truth, error.png into the folder; returns their names.
std::vector<std::string> draw_run(const std::filesystem::path& folder, const RunFigures& figures);

}  // namespace nadir::cli
