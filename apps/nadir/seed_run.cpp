// SPDX-License-Identifier: Apache-2.0
#include "seed_run.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nadir/pipelines/site.hpp"
#include "run_files.hpp"

namespace nadir::cli {
namespace {

/// Frames a second; 0 where no time passed.
double rate(std::size_t frames, double seconds) {
  return seconds > 0.0 ? static_cast<double>(frames) / seconds : 0.0;
}

double localize_rate(const RunResult& result) {
  return rate(result.records.size(), result.update_s());
}

double total_rate(const RunResult& result) {
  return rate(result.records.size(), result.update_s() + result.decode_s() + result.prepare_s);
}

}  // namespace

std::optional<SeedRun> run_and_judge(const RunPlan& plan,
                                     const std::function<void(int)>& progress) {
  SeedRun run{plan.seed, run_localizer(plan, progress), {}, {}};
  const std::size_t done = run.result.records.size();
  if (done == 0) return std::nullopt;
  run.truth = truth_of(plan.sequence, {plan.frames.begin(),
                                       plan.frames.begin() + static_cast<std::ptrdiff_t>(done)});
  if (!run.truth.empty()) {
    run.judgement = judged(run.result.trajectory(), covariances_of(run.result), run.truth);
  }
  return run;
}

Json to_json(const SeedRun& run) {
  return {{"seed", run.seed},
          {"frames", run.result.records.size()},
          {"compared", run.result.answered()},
          {"interrupted", run.result.interrupted},
          {"localize_frames_per_s", localize_rate(run.result)},
          {"total_frames_per_s", total_rate(run.result)},
          {"evaluation", run.judgement ? to_json(*run.judgement) : Json(nullptr)}};
}

std::string to_text(const SeedRun& run) {
  std::string text = fmt::format(
      "seed {}: {} frames, {} compared with the map; {:.1f} localized a second, {:.1f} with "
      "reading\n",
      run.seed, run.result.records.size(), run.result.answered(), localize_rate(run.result),
      total_rate(run.result));
  return run.judgement ? text + to_table(*run.judgement) : text;
}

std::optional<SeedSummary> summary_of(const std::vector<SeedRun>& runs) {
  std::vector<Evaluation> evaluations;
  for (const SeedRun& run : runs) {
    if (run.judgement) evaluations.push_back(run.judgement->evaluation);
  }
  if (evaluations.empty()) return std::nullopt;
  return summarise(evaluations);
}

}  // namespace nadir::cli
