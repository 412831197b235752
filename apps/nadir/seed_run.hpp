// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "evaluation_report.hpp"
#include "localize_run.hpp"

namespace nadir::cli {

/// One run of the localizer and, where there is a truth, how good it was.
struct SeedRun {
  std::uint64_t seed = 0;
  RunResult result;
  Trajectory truth;  ///< over the frames that were run; may be empty
  std::optional<Judgement> judgement;
};

/// Runs the plan and judges it. Throws Interrupted where it was stopped before the first frame.
SeedRun run_and_judge(const RunPlan& plan, const std::function<void(int)>& progress);

/// Frames, rates and evaluation. The localize rate is that of Localizer::update() alone, the total
/// rate includes decoding and the preparation of the map.
Json to_json(const SeedRun& run);
std::string to_text(const SeedRun& run);

/// Mean and spread over the seeds that have a truth.
std::optional<SeedSummary> summary_of(const std::vector<SeedRun>& runs);

}  // namespace nadir::cli
