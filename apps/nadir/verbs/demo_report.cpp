// SPDX-License-Identifier: Apache-2.0
#include "verbs/demo_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "nadir/report/text_table.hpp"

namespace nadir::cli {
namespace {

double number(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// Folders and files of the demo with something to see, in the order of the pipeline.
std::vector<std::pair<std::string, std::string>> pictures(const DemoPlan& plan,
                                                          const std::string& out) {
  return {{"drone photos", out + "/site/photos/"},
          {"stereo pairs", out + "/site/stereo/"},
          {"the drone's map", plan.map},
          {"what the robot mapped", out + "/drive/overview.png"},
          {"one local map in the whole map", out + "/match/heat_map_zwncc.png"},
          {"truth, odometry and estimate", out + "/run/trajectory.png"},
          {"the particles", out + "/run/swarm.png"}};
}

}  // namespace

void DemoResult::add(const DemoStep& step, const Json& document, double seconds) {
  const auto known = std::ranges::find(stages, step.stage, &std::pair<std::string, double>::first);
  if (known == stages.end()) {
    stages.emplace_back(step.stage, seconds);
  } else {
    known->second += seconds;
  }
  if (step.stage == "eval") judged.push_back(document);
  if (step.is_nadirs_own) {
    for (const Json& doubt : document.value("doubtful", Json::array())) {
      verdict.doubt(step.stage + ": " + doubt.get<std::string>());
    }
  }
  if (step.stage == "report") report = document["report"].get<std::string>();
}

std::string in_words(const DemoStep& step, const Json& document) {
  if (step.stage == "simulate") {
    return fmt::format("{} photos, {} stereo pairs over {:.0f} m", document["photos"].get<int>(),
                       document["frames"].get<int>(), number(document["travel_m"]));
  }
  if (step.stage == "map") {
    return fmt::format("{} of {} photos joined, {:.2f} m a pixel",
                       document["registered"].get<int>(), document["used"].get<int>(),
                       number(document["gsd_m"]));
  }
  if (step.stage == "ground") {
    return fmt::format("{} frames, at the last one {:.0f} % of 18 m x 18 m seen",
                       document["frames"].get<int>(), 100.0 * number(document["coverage_18m"]));
  }
  if (step.stage == "match") {
    const Json& candidates = document["matches"][0]["candidates"];
    if (candidates.empty()) return "not found";
    return fmt::format("found in the whole map, {:.2f} m off", number(candidates[0]["error_m"]));
  }
  if (step.stage == "localize") {
    return fmt::format("{} frames, {:.1f} a second", document["frames"].get<int>(),
                       number(document["localize_frames_per_s"]));
  }
  if (step.stage == "report") return document["report"].get<std::string>();
  return fmt::format("{:.3f} m, {:.2f} degrees (RMSE)", number(document["ape_trans_m"]["rmse"]),
                     number(document["yaw_deg"]["rmse"]));
}

std::string to_text(const DemoResult& result, const DemoPlan& plan, const std::string& out) {
  std::vector<std::vector<std::string>> rows{{"", "RMSE, m", "yaw, deg", "max, m"}};
  for (std::size_t i = 0; i < result.judged.size(); ++i) {
    const Json& judged = result.judged[i];
    rows.push_back({demo_methods()[i].name, fixed(number(judged["ape_trans_m"]["rmse"]), 3),
                    fixed(number(judged["yaw_deg"]["rmse"]), 2),
                    fixed(number(judged["ape_trans_m"]["max"]), 2)});
  }
  std::string text = "\n" + text_table(rows) + "\n";
  std::size_t width = 0;
  for (const auto& [what, where] : pictures(plan, out)) width = std::max(width, what.size());
  for (const auto& [what, where] : pictures(plan, out)) {
    text += fmt::format("  {:<{}}  {}\n", what, width, where);
  }
  return text + "\nopen " + result.report + "\n";
}

Json to_json(const DemoResult& result, const DemoPlan& plan, const std::string& out) {
  Json document{{"methods", Json::object()}, {"stages", Json::object()}};
  for (std::size_t i = 0; i < result.judged.size(); ++i) {
    const Json& judged = result.judged[i];
    document["methods"][demo_methods()[i].name] = {{"ape_rmse_m", judged["ape_trans_m"]["rmse"]},
                                                   {"yaw_rmse_deg", judged["yaw_deg"]["rmse"]},
                                                   {"max_m", judged["ape_trans_m"]["max"]}};
  }
  for (const auto& [stage, seconds] : result.stages) document["stages"][stage] = seconds;
  document["stand_ins"] = plan.stand_ins;
  document["report"] = result.report;
  document["pictures"] = Json::array();
  for (const auto& [what, where] : pictures(plan, out)) document["pictures"].push_back(where);
  return document;
}

}  // namespace nadir::cli
