// SPDX-License-Identifier: Apache-2.0
#include "run_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "nadir/core/angle.hpp"

namespace nadir::cli {
namespace {

constexpr std::size_t kMostStretches = 6;
/// From here on the reader is told.
constexpr double kLeastCompared = 0.9;  ///< share of the frames
constexpr double kLeastInside = 0.85;   ///< share of the frames under their 95 % quantile

std::string frames_text(std::size_t count) {
  return fmt::format("{} frame{}", count, count == 1 ? "" : "s");
}

std::map<std::string, std::vector<int>> frames_by_status(const RunRecord& run) {
  std::map<std::string, std::vector<int>> numbers;
  for (const ViewFrame& frame : run.frames) numbers[frame.status].push_back(frame.number);
  return numbers;
}

std::size_t compared(const RunRecord& run) {
  return static_cast<std::size_t>(std::ranges::count(run.frames, "ok", &ViewFrame::status));
}

void warn_of_frames(const RunRecord& run, std::vector<std::string>& warnings) {
  const auto all = static_cast<double>(run.frames.size());
  if (static_cast<double>(compared(run)) >= kLeastCompared * all) return;
  for (const auto& [status, numbers] : frames_by_status(run)) {
    if (status == "ok") continue;
    warnings.push_back(fmt::format("{} not compared with the map: {} (frames {}).",
                                   frames_text(numbers.size()), status_in_words(status),
                                   stretches(numbers)));
  }
}

void warn_of_accuracy(const Judgement& judgement, std::vector<std::string>& warnings) {
  const Evaluation& e = judgement.evaluation;
  if (e.unanswered_frames > 0) {
    warnings.push_back(fmt::format("{} with a truth got no estimate.",
                                   frames_text(static_cast<std::size_t>(e.unanswered_frames))));
  }
  const auto& c = judgement.consistency;
  if (c && c->frames > 0 && c->share_within_95 < kLeastInside) {
    warnings.push_back(fmt::format(
        "The covariance is too small: {:.0f} % of the frames lie within what it says holds 95 %.",
        100.0 * c->share_within_95));
  }
}

/// A reason as errors have it, as a sentence.
std::string sentence(std::string reason) {
  reason.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(reason.front())));
  return reason + ".";
}

RunSummary summary_of(const RunRecord& run) {
  const ViewFrame& last = run.frames.back();
  return {run.frames.size(), compared(run), last.covariance,
          last.cluster_mass, last.clusters, run.judgement ? &*run.judgement : nullptr};
}

bool was_interrupted(const RunRecord& run) {
  const Json stages = run.manifest.value("stages", Json::array());
  return std::ranges::any_of(stages, [](const Json& stage) {
    return stage.value("name", std::string{}).find("interrupted") != std::string::npos;
  });
}

std::string accuracy(const RunRecord& run) {
  if (!run.judgement) {
    return fmt::format(
        "No true trajectory is known, so that its error cannot be told; at the end "
        "the filter itself reckons with {:.2f} m (2 sigma).",
        two_sigma_m(run.frames.back().covariance));
  }
  const Evaluation& e = run.judgement->evaluation;
  return fmt::format(
      "The position is off by {:.2f} m (root mean square), {:.2f} m at most; the "
      "heading by {:.2f}\u00b0.",
      e.ape_translation_m.rmse, e.ape_translation_m.max, degrees(e.ape_yaw_rad.rmse));
}

/// How it went, in one word.
std::string verdict(const RunRecord& run) {
  if (compared(run) == 0) return "Not localized";
  if (!run.judgement) return "Localized";
  const Evaluation& e = run.judgement->evaluation;
  if (!e.time_to_converge_s) return "Lost";
  if (e.lost_count > 0) return "Localized after being lost";
  return e.ape_translation_m.rmse <= kHalfMetre ? "Localized well" : "Localized";
}

}  // namespace

std::string stretches(const std::vector<int>& numbers) {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++count) {
    if (count == kMostStretches) return text + ", ...";
    std::size_t end = i + 1;
    while (end < numbers.size() && numbers[end] == numbers[end - 1] + 1) ++end;
    if (!text.empty()) text += ", ";
    text += std::to_string(numbers[i]);
    if (end - i > 1) text += "-" + std::to_string(numbers[end - 1]);
    i = end;
  }
  return text;
}

std::string status_in_words(const std::string& status) {
  if (status == "ok") return "compared with the map";
  if (status == "no_overlap") return "too little of the local map lies in the map";
  if (status == "no_texture") return "the local map has nothing to compare";
  if (status == "no_odometry") return "the motion since the last frame is not known";
  return status;
}

double two_sigma_yaw_rad(const PoseCovariance& covariance) {
  return 2.0 * std::sqrt(std::max(0.0, covariance(2, 2)));
}

RunWords words_of(const RunRecord& run) {
  RunWords words;
  words.headline = fmt::format("{}: {} of {} compared with the map. {}", verdict(run),
                               compared(run), frames_text(run.frames.size()), accuracy(run));
  if (was_interrupted(run)) {
    words.warnings.emplace_back("The run was interrupted: this is what was done until then.");
  }
  if (!run.truth_problem.empty()) {
    words.warnings.push_back("The truth could not be used: " + run.truth_problem + ".");
  }
  warn_of_frames(run, words.warnings);
  if (run.judgement) warn_of_accuracy(*run.judgement, words.warnings);
  for (const std::string& doubt : doubts_of(summary_of(run))) {
    words.warnings.push_back(sentence(doubt));
  }
  words.good = words.warnings.empty() && compared(run) > 0;
  return words;
}

}  // namespace nadir::cli
