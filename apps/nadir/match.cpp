// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "add_verb.hpp"
#include "effective_options.hpp"
#include "frame_range.hpp"
#include "interrupt.hpp"
#include "manifest_of.hpp"
#include "match_plan.hpp"
#include "match_report.hpp"
#include "nadir/core/error.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/image.hpp"
#include "nadir/io/orthomosaic_file.hpp"
#include "nadir/report/figures.hpp"
#include "output_folder.hpp"
#include "site.hpp"
#include "stopwatch.hpp"
#include "threads.hpp"
#include "verbs.hpp"

namespace nadir::cli {
namespace {

namespace fs = std::filesystem;

struct MatchVerbOptions {
  fs::path site;
  fs::path output;
  fs::path map;
  int frame = 0;
  bool all_scores = false;
  RegionOptions region;
  OptionSources sources;
};

/// Everything that the scores share.
struct Scene {
  Orthomosaic map;
  Orthomosaic local;
  std::optional<Pose2> truth;
  RegionChoice choice;
  int frame = 0;
};

void draw(const fs::path& folder, const Scene& scene, ScoredMatch& match) {
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

ScoredMatch match_one(const Scene& scene, const MatchingOptions& options, const fs::path& folder) {
  const MapIndex index(scene.map, options);
  const Template local = make_template(scene.local, options);
  ScoredMatch scored{options.score, options.effective_channel(), {}, 0.0, {}};
  const Stopwatch stopwatch;
  scored.result = match(index, local, scene.choice.region);
  scored.seconds = stopwatch.seconds();
  draw(folder, scene, scored);
  scored.result.volume = {};  // large, and drawn
  return scored;
}

Json describe(const std::vector<ScoredMatch>& matches, const Scene& scene) {
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

Scene read_scene(const MatchVerbOptions& options, std::uint64_t seed) {
  const Sequence sequence = read_sequence(options.site);
  const Sequence::LocalMap& local_map = find_frame(sequence, options.frame);
  const auto truth = truth_at(sequence, local_map.stamp);
  RegionChoice choice = choose_region(options.region, truth, seed);
  return {read_orthomosaic(map_path(sequence, options.map)), read_frame(sequence, local_map).local,
          truth, std::move(choice), options.frame};
}

int run(const MatchVerbOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  require_device(common);
  const ThreadLimit limit(common);
  const EffectiveOptions effective(options.sources);
  const std::vector<fs::path> inputs{options.map.empty() ? options.site : options.map,
                                     options.site};
  require_writable(options.output, common, inputs);
  const Scene scene = read_scene(options, common.seed);
  if (common.dry_run) {
    common.json ? print(describe({}, scene))
                : print("would search: " + scene.choice.explanation + "\n");
    return 0;
  }

  OutputFolder output(options.output, common, inputs);
  MatchingOptions matching = effective.values().matching;
  std::vector<ScoredMatch> matches;
  const Stopwatch stopwatch;
  for (const auto& [score, name] : kScoreNames) {
    stop_if_interrupted();
    if (!options.all_scores && score != effective.values().matching.score) continue;
    matching.score = score;
    matches.push_back(match_one(scene, matching, output.staging()));
  }
  const Json document = describe(matches, scene);
  write_file(output.staging() / "match.json", document.dump(2) + "\n");
  Manifest manifest = manifest_of(invocation, limit.threads(), inputs);
  manifest.stages.push_back({"match", stopwatch.seconds()});
  write_manifest(output.staging(), manifest, effective.table(), effective.origins());
  output.commit();
  common.json ? print(document)
              : print(scene.choice.explanation + "\n" + to_table(matches, scene.truth));
  if (std::ranges::any_of(matches, [](const auto& m) { return !m.result.candidates.empty(); })) {
    return 0;
  }
  throw Error(ErrorKind::kNoResult, "no place in the region could be compared",
              "frame " + std::to_string(scene.frame),
              "its status is " + to_string(matches.front().result.status));
}

}  // namespace

void add_match(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<MatchVerbOptions>(
      program, invocation, "match", "Find one local map in the map; draw the heat map", run);
  verb->add_option("site", options.site, "Site folder")->type_name("SITE")->required();
  verb->add_option("-o,--output", options.output, "Folder to write")->type_name("OUT")->required();
  verb->add_option("--frame", options.frame, "Number of the local map")->required();
  verb->add_option("--map", options.map, "Orthomosaic to use instead of the site's");
  verb->add_option("--window", options.region.window_m,
                   "Half the side of the search window, metres, around the truth but moved off it; "
                   "without it the whole map is searched")
      ->check(CLI::PositiveNumber);
  verb->add_option("--centre", options.region.centre, "Centre of the window")->type_name("X,Y");
  verb->add_option("--yaw-deg", options.region.yaw_deg, "Heading (default: of the truth)");
  verb->add_option("--yaw-range-deg", options.region.yaw_range_deg,
                   "Search this far to both sides of the heading; 180 = every heading")
      ->check(CLI::Range(0.0, 180.0))
      ->capture_default_str();
  verb->add_flag("--all-scores", options.all_scores, "Compare every score");
  add_option_sources(*verb, options.sources);
  add_option_flag(*verb, options.sources, "--score", "map_matching.score");
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir match out/site --frame 170 -o out/match\n"
      "  nadir match out/site --frame 170 --window 15 --all-scores -o out/scores --json\n"
      "OUT holds match.json, manifest.json and a heat map a score.\n");
}

}  // namespace nadir::cli
