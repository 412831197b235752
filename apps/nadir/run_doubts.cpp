// SPDX-License-Identifier: Apache-2.0
#include "run_doubts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace nadir::cli {
namespace {

constexpr double kUncertainBeyond = 2.0;  ///< metres
constexpr double kSureOfCluster = 0.9;    ///< share of the weight
constexpr double kLeastCompared = 0.5;    ///< share of the frames

void doubt_coverage(const RunSummary& run, std::vector<std::string>& doubts) {
  const auto frames = static_cast<double>(run.frames);
  if (static_cast<double>(run.compared) >= kLeastCompared * frames) return;
  doubts.push_back(
      fmt::format("only {} of {} frames could be compared with the map", run.compared, run.frames));
}

void doubt_accuracy(const Evaluation& evaluation, std::vector<std::string>& doubts) {
  if (evaluation.lost_count > 0) {
    doubts.push_back(fmt::format("the estimate was more than {:g} m from the truth {} time{}",
                                 kLostBeyond, evaluation.lost_count,
                                 evaluation.lost_count == 1 ? "" : "s"));
  }
  if (!evaluation.time_to_converge_s) {
    doubts.emplace_back("the error did not come to stay under 1 m");
  }
}

void doubt_end(const RunSummary& run, std::vector<std::string>& doubts) {
  const double uncertain_m = two_sigma_m(run.last_covariance);
  if (uncertain_m > kUncertainBeyond) {
    doubts.push_back(
        fmt::format("at the end the position is uncertain by {:.1f} m (2 sigma)", uncertain_m));
  }
  if (run.last_cluster_mass < kSureOfCluster) {
    doubts.push_back(
        fmt::format("at the end the particles stand in {} places: the estimate is the heaviest, "
                    "with {:.0f} % of the weight",
                    run.last_clusters, 100.0 * run.last_cluster_mass));
  }
}

}  // namespace

double two_sigma_m(const PoseCovariance& covariance) {
  // The larger eigenvalue of the 2 x 2 block of the position.
  const double mean = 0.5 * (covariance(0, 0) + covariance(1, 1));
  const double half = std::hypot(0.5 * (covariance(0, 0) - covariance(1, 1)), covariance(0, 1));
  return 2.0 * std::sqrt(std::max(0.0, mean + half));
}

std::vector<std::string> doubts_of(const RunSummary& run) {
  std::vector<std::string> doubts;
  doubt_coverage(run, doubts);
  if (run.judgement != nullptr) doubt_accuracy(run.judgement->evaluation, doubts);
  doubt_end(run, doubts);
  return doubts;
}

std::vector<std::string> doubts_of(const SeedRun& run) {
  const Estimate& last = run.result.records.back().estimate;
  return doubts_of(RunSummary{
      run.result.records.size(), static_cast<std::size_t>(run.result.answered()), last.covariance,
      last.cluster_mass, last.clusters, run.judgement ? &*run.judgement : nullptr});
}

}  // namespace nadir::cli
