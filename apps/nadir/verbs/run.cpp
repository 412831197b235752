// SPDX-License-Identifier: Apache-2.0
#include "cli/add_verb.hpp"
#include "cli/option_flags.hpp"
#include "cli/start_options.hpp"
#include "nadir/pipelines/threads.hpp"
#include "run_job.hpp"
#include "verbs/verbs.hpp"

namespace nadir::cli {
namespace {

struct RunVerbOptions {
  DriveOptionsOfVerb drive;
  LocalizeOptions localizing;
};

int run(const RunVerbOptions& options, const Invocation& invocation) {
  require_device(invocation.common.device);
  const ThreadLimit limit(invocation.common.threads);
  RunJob job(options.drive, options.localizing, invocation, limit.threads());
  if (invocation.common.dry_run) return job.explain();
  return job.run();
}

}  // namespace

void add_run(CLI::App& program, Invocation& invocation) {
  auto [verb, options] = add_verb<RunVerbOptions>(
      program, invocation, "run", "Map a recorded drive and localize it on the way", run);
  add_drive_options(*verb, options.drive);
  verb->add_option("-o,--output", options.localizing.run, "Run folder to write")
      ->type_name("RUN")
      ->required();
  verb->add_option("--map", options.localizing.map, "The drone's orthomosaic")
      ->type_name("FILE")
      ->required();
  verb->add_option("--surface", options.localizing.surface, "Its heights, to be compared too")
      ->type_name("FILE");
  add_start_options(*verb, options.localizing.start);
  verb->add_option("--seeds", options.localizing.seeds, "Run this many seeds, from --seed on")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb->add_flag("--keep-maps", options.localizing.keep_maps,
                 "Keep the local maps as a site, RUN/site, which `nadir view RUN` shows");
  add_option_sources(*verb, options.localizing.sources);
  add_option_flag(*verb, options.localizing.sources, "--score", "map_matching.score");
  add_option_flag(*verb, options.localizing.sources, "--particles", "localization.particles");
  add_writing_options(*verb, invocation.common);
  add_computing_options(*verb, invocation.common);
  verb->footer(
      "Examples:\n"
      "  nadir run drive --map campus.tif -o out/run --prior 12.0,30.5,90\n"
      "  nadir run drive.bag --map campus.tif -o out/run --prior 12.0,30.5,90 --every 1m --json\n"
      "  nadir run drive --map campus.tif -o out/run --prior truth --seeds 5 --keep-maps\n"
      "The same as `nadir ground` and `nadir localize` without files between them: RUN is what\n"
      "`nadir localize` writes, INPUT what `nadir ground` takes. With --seeds the drive is mapped "
      "once\n"
      "and its local maps stay in memory, about 0.3 MB each of 18 m.\n");
}

}  // namespace nadir::cli
