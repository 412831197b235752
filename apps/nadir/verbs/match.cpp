// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/add_verb.hpp"
#include "cli/context.hpp"
#include "cli/interrupt.hpp"
#include "cli/option_flags.hpp"
#include "cli/verdict.hpp"
#include "match_scene.hpp"
#include "nadir/core/error.hpp"
#include "nadir/evaluation/evaluation.hpp"
#include "nadir/io/atomic_file.hpp"
#include "nadir/io/maps/orthomosaic_file.hpp"
#include "nadir/pipelines/effective_options.hpp"
#include "nadir/pipelines/frame_range.hpp"
#include "nadir/pipelines/manifest_of.hpp"
#include "nadir/pipelines/site.hpp"
#include "nadir/pipelines/stopwatch.hpp"
#include "nadir/pipelines/threads.hpp"
#include "nadir/runs/output_folder.hpp"
#include "verbs/verbs.hpp"

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

MatchScene read_scene(const MatchVerbOptions& options, std::uint64_t seed) {
  const Sequence sequence = read_sequence(options.site);
  const Sequence::LocalMap& local_map = find_frame(sequence, options.frame);
  const auto truth = truth_at(sequence, local_map.stamp);
  RegionChoice choice = choose_region(options.region, truth, seed);
  return {read_orthomosaic(map_path(sequence, options.map)), read_frame(sequence, local_map).local,
          truth, std::move(choice), options.frame};
}

std::vector<ScoredMatch> match_all(const MatchVerbOptions& options, const MatchScene& scene,
                                   MatchingOptions matching, const fs::path& folder) {
  const Score chosen = matching.score;
  std::vector<ScoredMatch> matches;
  for (const auto& [score, name] : kScoreNames) {
    stop_if_interrupted();
    if (!options.all_scores && score != chosen) continue;
    matching.score = score;
    matches.push_back(match_and_draw(scene, matching, folder));
  }
  return matches;
}

std::string reason(MatchStatus status) {
  return status == MatchStatus::kNoTexture
             ? "the local map, or the map below it, is of one grey"
             : "nowhere does enough of the local map lie on seen map: check --map, the window, the "
               "holes of the local map, and map_matching.min_valid_weight";
}

/// A true pose that the best place does not lie near.
std::vector<std::string> misses_of_truth(const ScoredMatch& match,
                                         const std::optional<Pose2>& truth,
                                         const std::string& where) {
  if (!truth || match.result.candidates.empty()) return {};
  const Pose2& best = match.result.candidates.front().map_from_robot;
  const double off_m = std::hypot(best.x - truth->x, best.y - truth->y);
  if (off_m <= kLostBeyond) return {};
  return {fmt::format("{}: the best place lies {:.1f} m from the true one", where, off_m)};
}

/// Of the score that was asked for; beside it, --all-scores compares what they can.
Verdict verdict_of(const std::vector<ScoredMatch>& matches, const MatchScene& scene, Score asked) {
  Verdict verdict;
  const std::string where = "frame " + std::to_string(scene.frame);
  if (std::ranges::all_of(matches, [](const auto& m) { return m.result.candidates.empty(); })) {
    verdict.nothing_found({ErrorKind::kNoResult, "no place in the region could be compared", where,
                           reason(matches.front().result.status)});
    return verdict;
  }
  const auto match = std::ranges::find(matches, asked, &ScoredMatch::score);
  if (match == matches.end()) return verdict;
  if (match->result.candidates.empty()) {
    verdict.doubt(fmt::format("{}: {} found no place, other scores did; {}", where,
                              to_string(asked), reason(match->result.status)));
  } else if (match->result.status == MatchStatus::kAmbiguous) {
    verdict.doubt(
        fmt::format("{}: another place fits nearly as well as the best (peak ratio {:.2f}); search "
                    "a smaller window, or localize over several frames",
                    where, match->result.peak_ratio));
  }
  verdict.doubt(misses_of_truth(*match, scene.truth, where));
  return verdict;
}

int run(const MatchVerbOptions& options, const Invocation& invocation) {
  const CommonOptions& common = invocation.common;
  require_device(common.device);
  const ThreadLimit limit(common.threads);
  EffectiveOptions effective(options.sources);
  effective.use_device(common.device);
  std::vector<fs::path> inputs{options.site};
  if (!options.map.empty()) inputs.push_back(options.map);
  require_writable(options.output, common.overwrite, inputs);
  const MatchScene scene = read_scene(options, common.seed);
  if (common.dry_run) {
    common.json ? print(to_json({}, scene))
                : print("would search: " + scene.choice.explanation + "\n");
    return 0;
  }

  OutputFolder output(options.output, common.overwrite, inputs);
  note_device(common);
  const Stopwatch stopwatch;
  const auto matches = match_all(options, scene, effective.values().matching, output.staging());
  const Verdict verdict = verdict_of(matches, scene, effective.values().matching.score);
  Json document = to_json(matches, scene);
  add_verdict(document, verdict);
  write_file(output.staging() / "match.json", json_text(document, 2) + "\n");
  Manifest manifest = manifest_of(context_of(invocation), limit.threads(), inputs);
  manifest.stages.push_back({"match", stopwatch.seconds()});
  manifest.doubts = verdict.doubts();
  write_manifest(output.staging(), manifest, effective.table(), effective.origins());
  output.commit();
  return finish(document, scene.choice.explanation + "\n" + to_table(matches, scene.truth), verdict,
                common);
}

void add_region(CLI::App& verb, RegionOptions& region) {
  verb.add_option("--window", region.window_m,
                  "Half the side of the search window, metres, around the truth but moved off it; "
                  "without it the whole map is searched")
      ->check(CLI::PositiveNumber);
  verb.add_option("--centre", region.centre, "Centre of the window")->type_name("X,Y");
  verb.add_option("--yaw-deg", region.yaw_deg, "Heading (default: of the truth)");
  verb.add_option("--yaw-range-deg", region.yaw_range_deg,
                  "Search this far to both sides of the heading; 180 = every heading")
      ->check(CLI::Range(0.0, 180.0))
      ->capture_default_str();
}

}  // namespace

void add_match(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<MatchVerbOptions>(
      program, invocation, "match", "Find one local map in the map; draw the heat map", run);
  verb->add_option("site", options.site, "Site folder")->type_name("SITE")->required();
  verb->add_option("-o,--output", options.output, "Folder to write")->type_name("OUT")->required();
  verb->add_option("--frame", options.frame, "Number of the local map")->required();
  verb->add_option("--map", options.map, "Orthomosaic to use instead of the site's");
  add_region(*verb, options.region);
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
