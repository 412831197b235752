// SPDX-License-Identifier: Apache-2.0
#include "evaluation_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nadir/report/text_table.hpp"

namespace nadir::cli {
namespace {

Json to_json(const Statistics& s, double factor) {
  return {{"rmse", factor * s.rmse},       {"mean", factor * s.mean}, {"median", factor * s.median},
          {"std", factor * s.std},         {"min", factor * s.min},   {"max", factor * s.max},
          {"sse", factor * factor * s.sse}};
}

Json to_json(const MeanAndSpread& number, double factor) {
  return {{"mean", factor * number.mean},
          {"spread", factor * number.spread},
          {"lowest", factor * number.lowest},
          {"highest", factor * number.highest}};
}

Json to_json(const Consistency& c) {
  return {{"mean", c.mean_nees},       {"band_95", {c.band.low, c.band.high}},
          {"inside_band", c.inside()}, {"share_within_95", c.share_within_95},
          {"frames", c.frames},        {"singular_frames", c.singular_frames},
          {"degrees_of_freedom", 3}};
}

std::vector<std::string> row(const std::string& name, const Statistics& s, double factor) {
  std::vector<std::string> cells{name};
  for (const double value : {s.rmse, s.mean, s.median, s.std, s.min, s.max}) {
    cells.push_back(fixed(factor * value, 3));
  }
  return cells;
}

std::vector<std::string> row(const std::string& name, const MeanAndSpread& number, double factor,
                             int places) {
  return {name, fixed(factor * number.mean, places), fixed(factor * number.spread, places),
          fixed(factor * number.lowest, places), fixed(factor * number.highest, places)};
}

std::string convergence(const Evaluation& e) {
  return e.time_to_converge_s ? fixed(*e.time_to_converge_s, 1) + " s" : "never";
}

}  // namespace

Judgement judged(const Trajectory& estimated, const std::vector<StampedCovariance>& covariances,
                 const Trajectory& truth) {
  return {evaluate(estimated, truth, {}), Alignment::kNone,
          consistency(estimated, covariances, truth, {})};
}

Json to_json(const Judgement& judgement) {
  const Evaluation& e = judgement.evaluation;
  Json document = {{"ape_trans_m", to_json(e.ape_translation_m, 1.0)},
                   {"yaw_deg", to_json(e.ape_yaw_rad, degrees(1.0))},
                   {"rpe_trans_m", to_json(e.rpe_translation_m, 1.0)},
                   {"rpe_angle_deg", to_json(e.rpe_angle_rad, degrees(1.0))},
                   {"within",
                    {{"0.5m", e.share_within_half_metre},
                     {"1m", e.share_within_one_metre},
                     {"5deg", e.share_within_five_degrees}}},
                   {"frames", e.truth_frames},
                   {"matched", e.matched_frames},
                   {"unanswered", e.unanswered_frames},
                   {"time_to_converge_s", nullptr},
                   {"lost_count", e.lost_count},
                   {"alignment", to_string(judgement.alignment)}};
  if (e.time_to_converge_s) document["time_to_converge_s"] = *e.time_to_converge_s;
  if (judgement.consistency) document["nees"] = to_json(*judgement.consistency);
  return document;
}

Json to_json(const SeedSummary& summary) {
  return {{"seeds", summary.seeds},
          {"lost", summary.lost},
          {"ape_rmse_m", to_json(summary.ape_rmse_m, 1.0)},
          {"ape_max_m", to_json(summary.ape_max_m, 1.0)},
          {"yaw_rmse_deg", to_json(summary.yaw_rmse_rad, degrees(1.0))},
          {"within_0.5m", to_json(summary.share_within_half_metre, 1.0)},
          {"within_1m", to_json(summary.share_within_one_metre, 1.0)}};
}

std::string to_table(const Judgement& judgement) {
  const Evaluation& e = judgement.evaluation;
  std::string text = text_table({{"", "rmse", "mean", "median", "std", "min", "max"},
                                 row("APE position, m", e.ape_translation_m, 1.0),
                                 row("APE yaw, deg", e.ape_yaw_rad, degrees(1.0)),
                                 row("RPE position, m", e.rpe_translation_m, 1.0),
                                 row("RPE angle, deg", e.rpe_angle_rad, degrees(1.0))});
  text += fmt::format("\n  frames with truth {}, unanswered {}, alignment {}\n", e.truth_frames,
                      e.unanswered_frames, to_string(judgement.alignment));
  text += fmt::format("  within 0.5 m {}, 1 m {}, 5 deg {}; converged after {}, lost {} times\n",
                      percent(e.share_within_half_metre), percent(e.share_within_one_metre),
                      percent(e.share_within_five_degrees), convergence(e), e.lost_count);
  if (judgement.consistency) {
    const Consistency& c = *judgement.consistency;
    text += fmt::format("  NEES {:.2f}; 95 % band {:.2f} to {:.2f} if frames were independent\n",
                        c.mean_nees, c.band.low, c.band.high);
  }
  return text;
}

std::string to_table(const SeedSummary& s) {
  return text_table({{"", "mean", "spread", "lowest", "highest"},
                     row("APE RMSE, m", s.ape_rmse_m, 1.0, 3),
                     row("APE max, m", s.ape_max_m, 1.0, 3),
                     row("yaw RMSE, deg", s.yaw_rmse_rad, degrees(1.0), 3),
                     row("within 0.5 m, %", s.share_within_half_metre, 100.0, 1),
                     row("within 1 m, %", s.share_within_one_metre, 100.0, 1)}) +
         fmt::format("\n  seeds {}, lost (error beyond 2 m) {}\n", s.seeds, s.lost);
}

}  // namespace nadir::cli
