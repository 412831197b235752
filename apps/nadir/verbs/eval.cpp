// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/verdict.hpp"
#include "evaluation_report.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/trajectories/tum.hpp"
#include "nadir/pipelines/frame_range.hpp"
#include "run_files.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct EvalOptions {
  fs::path trajectory;
  fs::path truth;
  std::string frames;
  bool align_origin = false;
  bool align = false;
  bool correct_scale = false;
  double delta = 1.0;
  std::string delta_unit = "f";
  double t_max_diff_s = EvaluationOptions{}.t_max_diff_s;
};

Alignment alignment_of(const EvalOptions& options) {
  if (options.align_origin) return Alignment::kOrigin;
  if (!options.align) return Alignment::kNone;
  return options.correct_scale ? Alignment::kSim2 : Alignment::kSe2;
}

Stamp whole_seconds(int seconds) { return Stamp{std::int64_t{seconds} * 1'000'000'000}; }

/// Frame numbers as stamps: those of the site that the truth lies in; without one a number is
/// taken as its own stamp in seconds.
void restrict_to_frames(const EvalOptions& options, EvaluationOptions& evaluation) {
  if (options.frames.empty()) return;
  const FrameRange range = parse_frame_range(options.frames);
  const fs::path site = fs::absolute(options.truth).parent_path();
  if (fs::exists(site / "sequence.yaml")) {
    const auto frames = select_frames(read_sequence(site), range);
    evaluation.first = frames.front().stamp;
    evaluation.last = frames.back().stamp;
    return;
  }
  evaluation.first = whole_seconds(range.first);
  evaluation.last = whole_seconds(range.last);
}

/// How many poses of a trajectory lie in the range that is judged.
int poses_in_range(const Trajectory& trajectory, const EvaluationOptions& range) {
  return static_cast<int>(std::ranges::count_if(trajectory, [&](const auto& stamped) {
    return (!range.first || stamped.stamp >= *range.first) &&
           (!range.last || stamped.stamp <= *range.last);
  }));
}

/// An evaluation of few of the poses says little of the others. The sparser of the two trajectories
/// counts: a truth of a higher rate, or of a lower one, is none the worse.
void judge_coverage(const Evaluation& evaluation, int poses, const EvalOptions& options,
                    Verdict& verdict) {
  if (2 * evaluation.matched_frames >= std::min(poses, evaluation.truth_frames)) return;
  verdict.doubt(fmt::format(
      "{}: only {} of its {} poses have one of the {} true poses within {} s; give another "
      "--t-max-diff, and check that both files have the stamps of one clock",
      options.trajectory.string(), evaluation.matched_frames, poses, evaluation.truth_frames,
      options.t_max_diff_s));
}

Judgement judge(const EvalOptions& options, Verdict& verdict) {
  EvaluationOptions evaluation;
  evaluation.t_max_diff_s = options.t_max_diff_s;
  evaluation.alignment = alignment_of(options);
  evaluation.rpe_delta = options.delta;
  evaluation.rpe_delta_unit = options.delta_unit == "m" ? DeltaUnit::kMetres : DeltaUnit::kFrames;
  restrict_to_frames(options, evaluation);

  const Trajectory estimated = read_tum(options.trajectory);
  const Trajectory truth = read_tum(options.truth);
  Judgement judgement{evaluate(estimated, truth, evaluation), evaluation.alignment, {}};
  judge_coverage(judgement.evaluation, poses_in_range(estimated, evaluation), options, verdict);
  const fs::path covariances = fs::absolute(options.trajectory).parent_path() / "covariance.csv";
  // A covariance speaks of the pose in the map: aligning takes away what it is about.
  if (evaluation.alignment == Alignment::kNone && fs::exists(covariances)) {
    judgement.consistency =
        consistency(estimated, read_covariances(covariances), truth, evaluation);
  }
  return judgement;
}

int run(const EvalOptions& options, const Invocation& invocation) {
  Verdict verdict;
  const Judgement judgement = judge(options, verdict);
  return finish(to_json(judgement), to_table(judgement), verdict, invocation.common);
}

void add_options(CLI::App& verb, EvalOptions& options) {
  verb.add_option("trajectory", options.trajectory, "Estimated trajectory, TUM")
      ->type_name("TRAJECTORY")
      ->required();
  verb.add_option("--truth", options.truth, "True trajectory, TUM")->type_name("FILE")->required();
  verb.add_option("--frames", options.frames,
                  "Frames A:B, both included: numbers of the site that the truth lies in; without "
                  "a sequence.yaml beside it, stamps in seconds")
      ->type_name("A:B");
  CLI::Option* origin = verb.add_flag("--align-origin", options.align_origin,
                                      "Lay the first pose on the first truth");
  CLI::Option* align =
      verb.add_flag("--align", options.align, "Least-squares rotation and translation");
  align->excludes(origin);
  verb.add_flag("--correct-scale", options.correct_scale, "With --align: a scale too")
      ->needs(align);
  verb.add_option("--delta", options.delta, "Distance of the two ends of a relative error")
      ->capture_default_str();
  verb.add_option("--delta-unit", options.delta_unit, "f (frames) or m (metres of true path)")
      ->check(CLI::IsMember({"f", "m"}))
      ->capture_default_str();
  verb.add_option("--t-max-diff", options.t_max_diff_s, "Largest difference of stamps, seconds")
      ->capture_default_str();
}

}  // namespace

void add_eval(CLI::App& program, Invocation& invocation) {
  auto [verb, options] =
      add_verb<EvalOptions>(program, invocation, "eval",
                            "Judge a trajectory against the truth; unaligned by default", run);
  add_options(*verb, options);
  verb->footer(
      "Examples:\n"
      "  nadir eval out/run/trajectory.tum --truth out/site/truth.tum\n"
      "  nadir eval out/run/trajectory.tum --truth out/site/truth.tum --frames 160:224 --json\n"
      "The normalised error (NEES) is given where covariance.csv lies beside the trajectory.\n");
}

}  // namespace nadir::cli
