// SPDX-License-Identifier: Apache-2.0
#include "match_report.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "nadir/report/text_table.hpp"

namespace nadir::cli {
namespace {

double distance_m(const Pose2& a, const Pose2& b) { return std::hypot(a.x - b.x, a.y - b.y); }

Json to_json(const MatchCandidate& candidate, const std::optional<Pose2>& truth) {
  const Pose2& pose = candidate.map_from_robot;
  Json document{{"x", pose.x},
                {"y", pose.y},
                {"yaw_deg", degrees(pose.yaw)},
                {"score", candidate.score},
                {"valid_weight", candidate.valid_weight}};
  if (truth) {
    document["error_m"] = distance_m(pose, *truth);
    document["error_deg"] = degrees(wrap_angle(pose.yaw - truth->yaw));
  }
  return document;
}

std::string name_of(Channel channel) {
  for (const auto& [value, name] : kChannelNames) {
    if (value == channel) return name;
  }
  return {};
}

std::vector<std::string> row(const ScoredMatch& match, const std::optional<Pose2>& truth) {
  std::vector<std::string> cells{to_string(match.score), to_string(match.result.status)};
  if (match.result.candidates.empty()) return cells;
  const MatchCandidate& best = match.result.candidates.front();
  for (const double value :
       {best.map_from_robot.x, best.map_from_robot.y, degrees(best.map_from_robot.yaw), best.score,
        best.valid_weight, match.result.peak_ratio}) {
    cells.push_back(fixed(value, 3));
  }
  cells.push_back(truth ? fixed(distance_m(best.map_from_robot, *truth), 3) : "-");
  cells.push_back(fixed(1e3 * match.seconds, 1));
  return cells;
}

}  // namespace

Json to_json(const ScoredMatch& match, const std::optional<Pose2>& truth) {
  Json document{{"score", to_string(match.score)},
                {"channel", name_of(match.channel)},
                {"status", to_string(match.result.status)},
                {"peak_ratio", match.result.peak_ratio},
                {"heat_map", match.heat_map.empty() ? Json(nullptr) : Json(match.heat_map)}};
  document["candidates"] = Json::array();
  for (const MatchCandidate& candidate : match.result.candidates) {
    document["candidates"].push_back(to_json(candidate, truth));
  }
  return document;
}

std::string to_table(const std::vector<ScoredMatch>& matches, const std::optional<Pose2>& truth) {
  std::vector<std::vector<std::string>> rows{{"score", "status", "x, m", "y, m", "yaw, deg",
                                              "value", "valid", "peak ratio", "error, m", "ms"}};
  for (const ScoredMatch& match : matches) rows.push_back(row(match, truth));
  return text_table(rows);
}

}  // namespace nadir::cli
