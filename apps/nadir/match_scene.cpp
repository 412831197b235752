// SPDX-License-Identifier: Apache-2.0
#include "match_scene.hpp"

#include <nlohmann/json.hpp>

#include "cli/interrupt.hpp"
#include "nadir/io/image.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/report/figures.hpp"

namespace nadir::cli {
namespace {

void draw(const std::filesystem::path& folder, const MatchScene& scene, ScoredMatch& match) {
  if (match.result.candidates.empty()) return;
  const auto footprint = [&](const Pose2& pose) {
    return Footprint{pose, scene.local.geo, scene.local.width(), scene.local.height()};
  };
  HeatMap heat_map{&match.result.volume,
                   footprint(match.result.candidates.front().map_from_robot),
                   {},
                   !scene.choice.region.centre,
                   "frame " + std::to_string(scene.frame) + ", " + to_string(match.score)};
  if (scene.truth) heat_map.truth = footprint(*scene.truth);
  match.heat_map = "heat_map_" + to_string(match.score) + ".png";
  write_png(folder / match.heat_map, draw_heat_map(scene.map, scene.local, heat_map));
}

}  // namespace

ScoredMatch match_and_draw(const MatchScene& scene, const MatchingOptions& options,
                           const std::filesystem::path& folder) {
  const MapIndex index(scene.map, options);
  const Template local = make_template(scene.local, options);
  ScoredMatch scored{options.score, options.effective_channel(), {}, 0.0, {}};
  const Stopwatch stopwatch;
  scored.result = match(index, local, scene.choice.region, interrupt_token());
  scored.seconds = stopwatch.seconds();
  draw(folder, scene, scored);
  scored.result.volume = {};  // large, and drawn
  return scored;
}

Json to_json(const std::vector<ScoredMatch>& matches, const MatchScene& scene) {
  Json document{{"frame", scene.frame}, {"region", scene.choice.explanation}};
  document["truth"] = nullptr;
  if (scene.truth) {
    document["truth"] = {
        {"x", scene.truth->x}, {"y", scene.truth->y}, {"yaw_deg", degrees(scene.truth->yaw)}};
  }
  document["matches"] = Json::array();
  for (const ScoredMatch& match : matches)
    document["matches"].push_back(to_json(match, scene.truth));
  return document;
}

}  // namespace nadir::cli
