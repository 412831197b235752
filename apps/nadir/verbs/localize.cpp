// SPDX-License-Identifier: Apache-2.0
#include "cli/add_verb.hpp"
#include "cli/option_flags.hpp"
#include "cli/server_options.hpp"
#include "cli/start_options.hpp"
#include "localize_job.hpp"
#include "nadir/core/error.hpp"
#include "nadir/pipelines/threads.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

int run(const LocalizeOptions& options, const Invocation& invocation) {
  require_device(invocation.common.device);
  const ThreadLimit limit(invocation.common.threads);
  if (options.serve && options.seeds > 1) {
    throw Error(ErrorKind::kUsage, "one seed at a time can be watched", "--serve --seeds",
                "leave one of them out");
  }
  LocalizeJob job(options, invocation, limit.threads());
  if (invocation.common.dry_run) return job.explain();
  return job.run();
}

void add_inputs(CLI::App& verb, LocalizeOptions& options) {
  verb.add_option("site", options.site, "Site folder")->type_name("SITE")->required();
  verb.add_option("-o,--output", options.run, "Run folder to write")->type_name("RUN")->required();
  verb.add_option("--map", options.map, "Orthomosaic to use instead of the site's")
      ->type_name("FILE");
  verb.add_option("--surface", options.surface,
                  "Heights of the map, to compare with those of the local maps (default: the "
                  "site's, where its own map is used)")
      ->type_name("FILE");
  verb.add_option("--frames", options.frames,
                  "Frames A:B, both included (default: all; with --prior truth, from the first "
                  "that has a true pose)")
      ->type_name("A:B");
  verb.add_option("--odometry", options.odometry,
                  "file: the site's odometry; maps: registered from the local maps; auto: the file "
                  "where there is one")
      ->check(CLI::IsMember({"auto", "file", "maps"}))
      ->capture_default_str();
}

void add_start(CLI::App& verb, LocalizeOptions& options) {
  add_start_options(verb, options.start);
  verb.add_option("--seeds", options.seeds, "Run this many seeds, from --seed on")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
}

void add_serving(CLI::App& verb, LocalizeOptions& options) {
  CLI::Option* serve = verb.add_flag("--serve", options.serve,
                                     "Let browsers watch, and set the pose; goes on until Ctrl-C");
  verb.add_option("--rate", options.rate_hz, "At most this many frames a second (0: all it can)")
      ->check(CLI::Range(0.0, 1000.0))
      ->needs(serve);
  for (CLI::Option* option : add_server_options(verb, options.server)) option->needs(serve);
}

}  // namespace

void add_localize(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<LocalizeOptions>(program, invocation, "localize",
                                                   "Follow the robot through the map", run);
  add_inputs(*verb, options);
  add_start(*verb, options);
  add_serving(*verb, options);
  add_option_sources(*verb, options.sources);
  add_option_flag(*verb, options.sources, "--score", "map_matching.score");
  add_option_flag(*verb, options.sources, "--layers", "map_matching.layers");
  add_option_flag(*verb, options.sources, "--particles", "localization.particles");
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir localize out/site -o out/run --prior 12.0,30.5,90\n"
      "  nadir localize out/site -o out/run --prior truth --seed 3 --frames 160:224 --json\n"
      "  nadir localize out/site -o out/paper --preset paper --score wncc --prior truth --seeds "
      "20\n"
      "  nadir localize out/site -o out/run --prior truth --serve --rate 5\n"
      "RUN holds trajectory.tum (pose of the robot in the map), covariance.csv, frames.csv,\n"
      "timing.csv, manifest.json and figures; with --seeds, a folder seed_K for each seed.\n");
}

}  // namespace nadir::cli
